//! Properties of imported hardware by name, and what is said of them besides the source.

use std::borrow::Borrow;

use crate::netlist::Netlist;
use crate::netlist::cells::{Claim, Property};
use crate::trace::pattern::{fits, glob};

/// The properties among these that a glob names.
///
/// # Errors
/// A sentence: it is not a glob, or it names none.
pub(crate) fn matching<P: Borrow<Property>>(text: &str, all: impl Iterator<Item = P>) -> Result<Vec<P>, String> {
    let glob = glob(text)?;
    let (found, others): (Vec<P>, Vec<P>) = all.partition(|property| fits(&glob, &property.borrow().name));
    if found.is_empty() {
        let names: Vec<&str> = others.iter().map(|property| property.borrow().name.as_str()).collect();
        let names = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
        return Err(format!("it matches no property that it can be of; there are: {names}"));
    }
    Ok(found)
}

/// Announces that what the operators lose whose paths match is meant to be lost.
///
/// # Errors
/// A glob, and why it announces nothing.
pub(crate) fn announce(netlist: &mut Netlist, globs: &[String]) -> Result<(), (String, String)> {
    for glob in globs {
        refuse_undefined(glob, &netlist.properties).map_err(|why| (glob.clone(), why))?;
        let all = netlist.properties.iter_mut();
        let overflows = all.filter(|property| matches!(property.claim, Claim::Fits { .. }));
        let found: Vec<&mut Property> = matching(glob, overflows).map_err(|why| (glob.clone(), why))?;
        for property in found {
            if let Claim::Fits { wraps, .. } = &mut property.claim {
                *wraps = true;
            }
        }
    }
    Ok(())
}

/// Refuses a glob that names operations without a result, and nothing that loses a carry.
fn refuse_undefined(text: &str, all: &[Property]) -> Result<(), String> {
    let glob = glob(text)?;
    let mut undefined = None;
    for property in all.iter().filter(|property| fits(&glob, &property.name)) {
        match property.claim {
            Claim::Fits { .. } => return Ok(()),
            Claim::Defined { undefined: of, .. } => undefined = Some((property, of)),
            Claim::NoOverflow { .. } | Claim::Invariant | Claim::Assumption | Claim::Cover | Claim::Print { .. } => {}
        }
    }
    let Some((Property { name, .. }, of)) = undefined else { return Ok(()) };
    Err(format!("{name} is watched for a {}, which has no carry to lose: leave it out", of.description()))
}
