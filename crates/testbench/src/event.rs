//! Inputs that change while a machine runs.

use stepwave_models::events::{Action, Timed};
use stepwave_models::{ModelError, Port};
use stepwave_netlist::Net;

use super::Testbench;

/// An input takes a value right after the edge of a clock, so that the next edge samples it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Event {
    /// The clock, from 0.
    pub clock: u64,
    /// The input.
    pub input: Net,
    /// Its bits.
    pub value: u64,
}

impl Testbench {
    /// The same bench, where the operator acts at these clocks. Of several at one clock the last wins.
    ///
    /// # Errors
    /// The hardware has no input for an action.
    pub fn with_events(mut self, events: &[Timed]) -> Result<Testbench, ModelError> {
        let mut all = Vec::new();
        for Timed { clock, action } in events {
            for (later, name, value) in action.inputs() {
                let input = self.input(*action, name)?;
                let value = input.reading.wrapped(input.width, value).value();
                all.push((later == 0, Event { clock: clock.saturating_add(later), input: input.net, value }));
            }
        }
        // What ends by itself does so before the operator acts again at that clock.
        all.sort_by_key(|(acts, event)| (event.clock, *acts));
        self.events = all.into_iter().map(|(_, event)| event).collect();
        Ok(self)
    }

    /// The input of this name: other signals may have it too.
    fn input(&self, action: Action, name: &str) -> Result<Port, ModelError> {
        let (netlist, inputs) = (self.design().netlist(), self.design().inputs());
        let named = netlist.names.iter().find(|named| named.name == name && inputs.contains(&named.net));
        let named =
            named.ok_or_else(|| ModelError::NoEvents { model: self.hardware.model, event: action.to_string() })?;
        Ok(Port { net: named.net, width: netlist.width(named.net), reading: named.format.reading() })
    }
}
