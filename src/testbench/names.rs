//! Signals by name.

use crate::netlist::cells::NamedNet;
use crate::netlist::{Netlist, did_you_mean};

/// The net of this name, path, or end of a path, as it is declared under that name.
///
/// # Errors
/// A sentence: none or several have it.
pub(crate) fn net_named<'n>(netlist: &'n Netlist, name: &str) -> Result<&'n NamedNet, String> {
    let end = format!(".{name}");
    let all = netlist.names.iter().map(|named| (netlist.path(named), named));
    let mut found: Vec<(String, &NamedNet)> = all.filter(|(path, _)| path == name || path.ends_with(&end)).collect();
    found.dedup_by(|(_, a), (_, b)| a.nets().eq(b.nets()));
    match found.as_slice() {
        [] => {
            let known = netlist.names.iter().map(|named| named.name.as_str());
            Err(format!("there is no signal '{name}' in this netlist{}", did_you_mean(name, known)))
        }
        [(_, named)] => Ok(named),
        several => {
            let paths: Vec<&str> = several.iter().map(|(path, _)| path.as_str()).collect();
            Err(format!("'{name}' is the name of several signals: give one of {}", paths.join(", ")))
        }
    }
}
