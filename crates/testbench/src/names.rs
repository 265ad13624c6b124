//! Signals by name.

use stepwave_netlist::cells::NamedNet;
use stepwave_netlist::{Netlist, did_you_mean};

/// A signal cannot be asked for by this name. It prints as a sentence.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[error("{0}")]
pub struct SignalError(pub String);

/// The net of this name, path, or end of a path, as it is declared under that name.
///
/// # Errors
/// None or several have it.
pub fn net_named<'n>(netlist: &'n Netlist, name: &str) -> Result<&'n NamedNet, SignalError> {
    let end = format!(".{name}");
    let all = netlist.names.iter().map(|named| (netlist.path(named), named));
    let mut found: Vec<(String, &NamedNet)> = all.filter(|(path, _)| path == name || path.ends_with(&end)).collect();
    found.dedup_by(|(_, a), (_, b)| a.nets().eq(b.nets()));
    match found.as_slice() {
        [] => {
            let known = netlist.names.iter().map(|named| named.name.as_str());
            Err(SignalError(format!("there is no signal '{name}' in this netlist{}", did_you_mean(name, known))))
        }
        [(_, named)] => Ok(named),
        several => {
            let paths: Vec<&str> = several.iter().map(|(path, _)| path.as_str()).collect();
            Err(SignalError(format!("'{name}' is the name of several signals: give one of {}", paths.join(", "))))
        }
    }
}
