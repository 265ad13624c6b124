//! Texts that hardware prints while it runs, as `$display` of Verilog does.

use std::io::Write;

use crate::engine::Rows;
use crate::netlist::Netlist;
use crate::netlist::cells::{Claim, Property};
use crate::netlist::message::Message;
use crate::testbench::{Columns, Observer, ObserverError};
use crate::trace::timescale::ClockTime;

/// Writes the texts of a netlist as its samples come.
pub(super) struct Printed<'w> {
    texts: Vec<Text>,
    time: ClockTime,
    /// What the last sample makes of them, which is printed if there is an edge after it.
    pending: String,
    to: &'w mut dyn Write,
}

struct Text {
    message: Message,
    /// Columns and bits of each number, the lowest part first.
    numbers: Vec<Vec<(usize, usize)>>,
    once: bool,
    column: usize,
}

impl<'w> Printed<'w> {
    pub(super) fn of(netlist: &Netlist, columns: &Columns, time: ClockTime, to: &'w mut dyn Write) -> Printed<'w> {
        let text = |property: &Property| {
            let Claim::Print { message, numbers, once } = &property.claim else { return None };
            let part = |&net| (columns.index(net), netlist.width(net).get() as usize);
            let numbers = numbers.iter().map(|word| word.nets.iter().map(part).collect()).collect();
            let column = columns.index(property.never);
            Some(Text { message: message.clone(), numbers, once: *once, column })
        };
        let texts = netlist.properties.iter().filter_map(text).collect();
        Printed { texts, time, pending: String::new(), to }
    }
}

impl Text {
    fn shown(&self, rows: &Rows, row: usize, time: u64) -> String {
        let digits = |parts: &Vec<(usize, usize)>| -> String {
            parts.iter().rev().map(|&(column, bits)| format!("{:0bits$b}", rows.value(column, row))).collect()
        };
        let numbers: Vec<String> = self.numbers.iter().map(digits).collect();
        self.message.shown(numbers.iter().map(String::as_str), time)
    }
}

impl Observer for Printed<'_> {
    fn wants_steps(&self) -> bool {
        false
    }

    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        let Printed { texts, time, pending, to } = self;
        if texts.is_empty() || (pending.is_empty() && texts.iter().all(|text| !rows.any(text.column))) {
            return Ok(());
        }
        for row in 0..rows.len() {
            let clock = rows.clock(row);
            if !pending.is_empty() {
                to.write_all(pending.as_bytes())?;
                pending.clear();
            }
            for text in texts.iter().filter(|text| rows.value(text.column, row) == 1) {
                match text.once {
                    true if clock == 0 => to.write_all(text.shown(rows, row, 0).as_bytes())?,
                    true => {}
                    false => *pending += &text.shown(rows, row, (clock + 1).saturating_mul(time.ticks())),
                }
            }
        }
        Ok(())
    }
}
