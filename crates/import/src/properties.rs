//! Assertions, assumptions and covers of the source become properties; what is printed is noted.

use stepwave_netlist::cells::{Claim, Property};

use crate::design::{Design, is_property};
use crate::json::Cell;

/// What a cell claims: `assert`, `assume`, `cover`, …
fn flavour(cell: &Cell) -> &str {
    match cell.kind.as_str() {
        "$check" => cell.text("FLAVOR").unwrap_or("assert").trim(),
        kind => kind.trim_start_matches('$'),
    }
}

impl Design<'_> {
    /// A property for every assertion, assumption and cover: 1 where the condition is 0 while it is enabled; of a cover, 1.
    pub(crate) fn assertions(&mut self) {
        let module = self.module;
        let claims = |cell: &Cell| is_property(&cell.kind) || cell.kind == "$print";
        for (name, cell) in module.cells.iter().filter(|(_, cell)| claims(cell)) {
            let place = cell.place().map_or_else(|| name.clone(), |place| format!("{}:{}", place.file, place.line));
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
    }
}
