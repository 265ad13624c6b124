//! Signals by name.

use crate::netlist::{Net, Netlist, did_you_mean};

/// The net of this name, path, or end of a path.
///
/// # Errors
/// A sentence: none or several have it.
pub(crate) fn net_named(netlist: &Netlist, name: &str) -> Result<Net, String> {
    let end = format!(".{name}");
    let all = netlist.names.iter().map(|named| (netlist.path(named), named.net));
    let mut found: Vec<(String, Net)> = all.filter(|(path, _)| path == name || path.ends_with(&end)).collect();
    found.dedup_by_key(|(_, net)| *net);
    match found.as_slice() {
        [] => {
            let known = netlist.names.iter().map(|named| named.name.as_str());
            Err(format!("there is no signal '{name}' in this netlist{}", did_you_mean(name, known)))
        }
        [(_, net)] => Ok(*net),
        several => {
            let paths: Vec<&str> = several.iter().map(|(path, _)| path.as_str()).collect();
            Err(format!("'{name}' is the name of several signals: give one of {}", paths.join(", ")))
        }
    }
}
