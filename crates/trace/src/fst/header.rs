//! What comes before the changes: the header, the widths of the signals, and the tree of their names.

use std::io::{self, Seek, SeekFrom, Write};

use ::vcd::VarType;

use super::super::probe::Probe;
use super::super::vcd::{has_range, variable_type};
use super::FstHeader;
use super::lz4;
use crate::numbers::{push, push_u64};

/// Types of blocks.
const HEADER: u8 = 0;
const WIDTHS: u8 = 3;
const NAMES_IN_LZ4: u8 = 6;
/// Bytes of a block's type and its length.
const BLOCK_HEAD: u64 = 9;
/// Bytes of the header's texts.
const VERSION: usize = 128;
const DATE: usize = 119;
/// Entries of the tree.
const SCOPE: u8 = 254;
const UP: u8 = 255;
const MODULE: u8 = 0;
/// Types of variables.
const INTEGER: u8 = 1;
const PARAMETER: u8 = 2;
const REGISTER: u8 = 5;
const WIRE: u8 = 16;
/// A variable is not a port.
const NO_DIRECTION: u8 = 0;

/// What the header declares.
pub(super) struct Declared<'a> {
    /// Bits of every signal, in the order of their handles; the clock, if it is dumped, is the first.
    pub(super) widths: Vec<u32>,
    /// The signals of at most 64 bits: column and place among the signals.
    pub(super) narrow: Vec<(usize, usize)>,
    /// The others.
    pub(super) wide: Vec<(&'a Probe, usize)>,
    names: Vec<u8>,
    scopes: u64,
    variables: u64,
}

impl<'a> Declared<'a> {
    pub(super) fn new(header: &FstHeader<'a>) -> Declared<'a> {
        let mut declared = Declared {
            widths: Vec::new(),
            narrow: Vec::new(),
            wide: Vec::new(),
            names: Vec::new(),
            scopes: 0,
            variables: 0,
        };
        let mut open: Vec<&str> = Vec::new();
        if header.clk {
            let top = header.probes.first().map_or("top", |probe| probe.scopes[0].as_str());
            declared.scope(top);
            open.push(top);
            declared.widths.push(1);
            declared.variable(WIRE, "clk", 1, None);
        }
        for probe in header.probes {
            let common = open.iter().zip(&probe.scopes).take_while(|(a, b)| *a == b).count();
            declared.names.extend(open.drain(common..).map(|_| UP));
            for scope in &probe.scopes[common..] {
                declared.scope(scope);
                open.push(scope);
            }
            declared.probe(probe);
        }
        declared.names.extend(open.iter().map(|_| UP));
        declared
    }

    fn probe(&mut self, probe: &'a Probe) {
        let width = probe.width;
        let name = if has_range(probe) { format!("{} [{}:0]", probe.name, width - 1) } else { probe.name.clone() };
        let known = match probe.columns[..] {
            [column] => self.narrow.iter().find(|(other, _)| *other == column).map(|(_, signal)| *signal),
            _ => self.wide.iter().find(|(other, _)| other.columns == probe.columns).map(|(_, signal)| *signal),
        };
        self.variable(variable(probe), &name, width, known);
        if known.is_none() {
            let signal = self.widths.len();
            self.widths.push(width);
            match probe.columns[..] {
                [column] => self.narrow.push((column, signal)),
                _ => self.wide.push((probe, signal)),
            }
        }
    }

    fn scope(&mut self, name: &str) {
        self.names.extend([SCOPE, MODULE]);
        self.text(name);
        self.text("");
        self.scopes += 1;
    }

    /// Another name of a signal refers to it by its handle; 0 is a signal of its own.
    fn variable(&mut self, kind: u8, name: &str, width: u32, known: Option<usize>) {
        self.names.extend([kind, NO_DIRECTION]);
        self.text(name);
        push(u64::from(width), &mut self.names);
        push(known.map_or(0, |signal| signal as u64 + 1), &mut self.names);
        self.variables += 1;
    }

    fn text(&mut self, text: &str) {
        self.names.extend_from_slice(text.as_bytes());
        self.names.push(0);
    }

    /// The blocks before the changes.
    pub(super) fn blocks(&self, exponent: i8) -> Vec<u8> {
        let mut out = Vec::new();
        // Begin and end, which `finish` sets.
        let mut header = vec![0; 16];
        header.extend(std::f64::consts::E.to_le_bytes());
        let memory = 0;
        let sections = 0;
        for number in [memory, self.scopes, self.variables, self.widths.len() as u64, sections] {
            push_u64(number, &mut header);
        }
        header.extend(exponent.to_be_bytes());
        let version = format!("stepwave {}", env!("CARGO_PKG_VERSION"));
        for (text, room) in [(version.as_bytes(), VERSION), (b"", DATE)] {
            header.extend(text);
            header.resize(header.len() + room - text.len(), 0);
        }
        // From Verilog, and nothing added to times.
        header.push(0);
        push_u64(0, &mut header);
        block(HEADER, &header, &mut out);

        let mut widths = Vec::new();
        self.widths.iter().for_each(|&width| push(u64::from(width), &mut widths));
        let mut content = Vec::new();
        push_u64(widths.len() as u64, &mut content);
        push_u64(self.widths.len() as u64, &mut content);
        content.extend(widths);
        block(WIDTHS, &content, &mut out);

        let mut content = Vec::new();
        push_u64(self.names.len() as u64, &mut content);
        content.extend(lz4::block(&self.names));
        block(NAMES_IN_LZ4, &content, &mut out);
        out
    }
}

fn block(kind: u8, content: &[u8], out: &mut Vec<u8>) {
    out.push(kind);
    // The length counts itself.
    push_u64(content.len() as u64 + 8, out);
    out.extend_from_slice(content);
}

fn variable(probe: &Probe) -> u8 {
    match variable_type(probe) {
        VarType::Integer => INTEGER,
        VarType::Parameter => PARAMETER,
        VarType::Reg => REGISTER,
        _ => WIRE,
    }
}

/// Sets what is known at the end: the times and the number of sections.
pub(super) fn finish(out: &mut (impl Write + Seek), [begin, end]: [u64; 2], sections: u64) -> io::Result<()> {
    out.seek(SeekFrom::Start(BLOCK_HEAD))?;
    out.write_all(&[begin.to_be_bytes(), end.to_be_bytes()].concat())?;
    // After the pattern that shows the order of bytes, and four numbers.
    out.seek(SeekFrom::Start(BLOCK_HEAD + 7 * 8))?;
    out.write_all(&sections.to_be_bytes())?;
    out.seek(SeekFrom::End(0))?;
    Ok(())
}
