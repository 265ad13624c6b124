//! Assertions, assumptions and covers of the source become properties, and texts that it prints.

use stepwave_netlist::Net;
use stepwave_netlist::cells::{self, Claim, Property};
use stepwave_netlist::message::Message;

use crate::design::{Design, is_property};
use crate::json::{Cell, Wire};

/// What a cell claims: `assert`, `assume`, `cover`, …
fn flavour(cell: &Cell) -> &str {
    match cell.kind.as_str() {
        "$check" => cell.text("FLAVOR").unwrap_or("assert").trim(),
        kind => kind.trim_start_matches('$'),
    }
}

/// When a text is printed, as the cell has it.
enum Trigger {
    /// At an edge of the clock.
    Edge,
    /// When the run begins.
    Start,
    /// Whenever a number in it changes, or at an edge of something else.
    Other,
}

impl Design<'_> {
    /// A property for every assertion, assumption and cover: 1 where the condition is 0 while it is enabled; of a cover, 1.
    /// A text that is printed is one too.
    pub(crate) fn assertions(&mut self, clock: Option<u32>) {
        let module = self.module;
        let cells = || module.cells.iter();
        for (name, cell) in cells().filter(|(_, cell)| is_property(&cell.kind)) {
            let place = cell.line().unwrap_or_else(|| name.clone());
            let flavour = flavour(cell);
            let claim = match flavour {
                "assert" => Claim::Invariant,
                "assume" => Claim::Assumption,
                "cover" => Claim::Cover,
                _ => {
                    self.notes.push(format!("{flavour} at {place} is not looked at"));
                    continue;
                }
            };
            self.at(cell);
            let [condition, enable] = ["A", "EN"].map(|pin| self.word(cell.pin(pin)).parts[0]);
            let shows = if flavour == "cover" { condition } else { self.builder.invert(condition) };
            let never = self.builder.and(shows, enable);
            self.builder.netlist.properties.push(Property { name: format!("{flavour} at {place}"), never, claim });
        }
        let mut texts: Vec<_> = cells().filter(|(_, cell)| cell.kind == "$print").collect();
        // Of several at one edge those that the source has first have the greater priority.
        texts.sort_by_key(|(_, cell)| std::cmp::Reverse(cell.number("PRIORITY")));
        for (name, cell) in texts {
            let place = cell.line().unwrap_or_else(|| name.clone());
            if let Err(why) = self.text(cell, &place, clock) {
                self.notes.push(format!("print at {place} is not looked at: {why}"));
            }
        }
    }

    /// A text that is printed.
    fn text(&mut self, cell: &Cell, place: &str, clock: Option<u32>) -> Result<(), String> {
        let once = match trigger(cell, clock) {
            Trigger::Edge => false,
            Trigger::Start => true,
            Trigger::Other => return Err("it is not printed at the edge of the clock".to_owned()),
        };
        let message = Message::parse(cell.text("FORMAT").unwrap_or_default())
            .map_err(|expected| format!("expected {expected}"))?;
        self.at(cell);
        let mut rest = cell.pin("ARGS");
        let mut numbers = Vec::new();
        for bits in message.numbers() {
            let Some((own, after)) = rest.split_at_checked(bits as usize) else {
                return Err("its text shows more bits than there are".to_owned());
            };
            let nets: Vec<Net> = self.word(own).parts;
            numbers.push(cells::Word { nets, signed: false });
            rest = after;
        }
        let never = self.word(cell.pin("EN")).parts[0];
        let claim = Claim::Print { message, numbers, once };
        self.builder.netlist.properties.push(Property { name: format!("print at {place}"), never, claim });
        Ok(())
    }
}

fn trigger(cell: &Cell, clock: Option<u32>) -> Trigger {
    if !cell.flag("TRG_ENABLE") {
        return Trigger::Other;
    }
    match cell.pin("TRG") {
        [] => Trigger::Start,
        [Wire::Net(net)] if Some(*net) == clock => Trigger::Edge,
        _ => Trigger::Other,
    }
}
