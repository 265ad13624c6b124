//! The one clock of a design.

use crate::ImportError;
use crate::cells::is_register;
use crate::design::Design;
use crate::json::{Cell, Wire};

/// The clock: which net, which edge.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Clock {
    /// Name of the input.
    pub name: String,
    /// Its rising edge; else the falling one.
    pub rising: bool,
}

/// A clock pin of a cell: what is on it, and whether the rising edge counts.
fn pins(cell: &Cell) -> Vec<(&Wire, bool)> {
    if is_register(&cell.kind) {
        let polarity = cell.polarity("CLK_POLARITY");
        return cell.pin("CLK").iter().map(|wire| (wire, polarity)).collect();
    }
    if cell.kind != "$mem_v2" {
        return Vec::new();
    }
    let ports = |side: &str| {
        let (clocked, rising) = (cell.bits(&format!("{side}_CLK_ENABLE")), cell.bits(&format!("{side}_CLK_POLARITY")));
        let wires = cell.pin(&format!("{side}_CLK")).iter().enumerate();
        let clocked = wires.filter(move |(port, _)| clocked.get(*port) == Some(&'1'));
        clocked.map(move |(port, wire)| (wire, rising.get(port) != Some(&'0'))).collect::<Vec<_>>()
    };
    [ports("RD"), ports("WR")].concat()
}

impl Design<'_> {
    /// The clock that every clocked cell has, with its numbered net; `None` of a design without clocked cells.
    pub(crate) fn clock(&self) -> Result<Option<(Clock, u32)>, ImportError> {
        let mut found: Option<(u32, bool, &String, &Cell)> = None;
        for (name, cell) in &self.module.cells {
            for (wire, rising) in pins(cell) {
                let user = || self.place(name, cell);
                let Wire::Net(net) = wire else {
                    let what = "a constant".to_owned();
                    return Err(ImportError::ComputedClock { clock: "constant".to_owned(), user: user(), what });
                };
                match found {
                    None => found = Some((*net, rising, name, cell)),
                    Some((other, edge, ..)) if other == *net && edge == rising => {}
                    Some((other, edge, first_name, first_cell)) => {
                        let shown = |net: u32, rising: bool| {
                            format!(
                                "the {} edge of '{}'",
                                if rising { "rising" } else { "falling" },
                                self.net_name(net)
                            )
                        };
                        return Err(ImportError::Clocks {
                            first: shown(other, edge),
                            first_user: Box::new(self.place(first_name, first_cell)),
                            second: shown(*net, rising),
                            second_user: Box::new(user()),
                        });
                    }
                }
            }
        }
        let Some((net, rising, name, cell)) = found else { return Ok(None) };
        let on = |wires: &[Wire]| wires.contains(&Wire::Net(net));
        let mut ports = self.module.ports.iter();
        let Some((port, _)) = ports.find(|(_, port)| port.direction == "input" && on(&port.bits)) else {
            let mut drivers = self.module.cells.iter();
            let driver = drivers.find(|(_, cell)| ["Y", "Q", "RD_DATA"].iter().any(|pin| on(cell.pin(pin))));
            let what = driver.map_or_else(
                || "driven by nothing".to_owned(),
                |(name, cell)| format!("driven by {}", self.place(name, cell)),
            );
            return Err(ImportError::ComputedClock { clock: self.net_name(net), user: self.place(name, cell), what });
        };
        self.refuse_as_data(net)?;
        Ok(Some((Clock { name: port.clone(), rising }, net)))
    }

    /// A clock that something reads other than as a clock.
    fn refuse_as_data(&self, net: u32) -> Result<(), ImportError> {
        let is_clock_pin = |pin: &str| matches!(pin, "CLK" | "RD_CLK" | "WR_CLK" | "TRG");
        let reads = |cell: &Cell| {
            cell.connections.iter().any(|(pin, wires)| !is_clock_pin(pin) && wires.contains(&Wire::Net(net)))
        };
        let cell = self
            .module
            .cells
            .iter()
            .find(|(_, cell)| reads(cell))
            .map(|(name, cell)| self.place(name, cell).to_string());
        let mut outputs = self.module.ports.iter().filter(|(_, port)| port.direction == "output");
        let output = || {
            outputs.find(|(_, port)| port.bits.contains(&Wire::Net(net))).map(|(name, _)| format!("output '{name}'"))
        };
        match cell.or_else(output) {
            Some(user) => Err(ImportError::ClockAsData { clock: self.net_name(net), user }),
            None => Ok(()),
        }
    }
}
