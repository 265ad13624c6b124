//! The samples of a run by name, for questions about a short run: in a test, in a notebook.

use stepwave_engine::Rows;
use stepwave_netlist::cells::NamedNet;
use stepwave_netlist::{Net, Netlist};

use super::{Observer, ObserverError, SignalError, Testbench, net_named};

/// Most values that are kept: 128 MB.
const MOST: usize = 1 << 24;

/// Keeps every sample of every named signal.
#[derive(Clone, Debug)]
pub struct Recording {
    netlist: Netlist,
    nets: Vec<Net>,
    /// A column for each of the nets.
    values: Vec<Vec<u64>>,
}

impl Recording {
    /// Nothing is recorded yet.
    #[must_use]
    pub fn new(bench: &Testbench) -> Recording {
        let nets = bench.columns().nets().to_vec();
        Recording { netlist: bench.design().netlist().clone(), values: vec![Vec::new(); nets.len()], nets }
    }

    /// What was recorded.
    #[must_use]
    pub fn into_trace(self) -> Trace {
        Trace { netlist: self.netlist, nets: self.nets, values: self.values }
    }
}

impl Observer for Recording {
    fn samples(&mut self, rows: &Rows) -> Result<(), ObserverError> {
        let held: usize = self.values.iter().map(Vec::len).sum();
        if held + rows.len() * self.values.len() > MOST {
            let clock = rows.first_clock();
            return Err(
                format!("a trace holds {MOST} values at most, which is full at clock {clock}: write a wave").into()
            );
        }
        for (column, values) in self.values.iter_mut().enumerate() {
            values.extend_from_slice(rows.column(column));
        }
        Ok(())
    }

    fn wants_steps(&self) -> bool {
        false
    }
}

/// The samples of a run, by signal. Sample k is the settled value of every net after clock edge k.
///
/// ```
/// # use stepwave_engine::EngineKind;
/// # use stepwave_models::{find, options::Options};
/// # use stepwave_nc::{Curve, Line};
/// # use stepwave_testbench::{Recording, Testbench};
/// let line = Curve::Line(Line::new(vec![0, 0], vec![4, 2])?);
/// let bench = Testbench::new(find("dda-line")?, &line, &Options::default())?;
/// let mut recording = Recording::new(&bench);
/// bench.run(EngineKind::Word, &mut [&mut recording]).expect("a recording has room");
/// let trace = recording.into_trace();
/// assert_eq!(trace.row("dx")?, "0001_0101_01"); // the pulses along X, a digit a clock
/// assert_eq!(trace.i64("x")?, [0, 0, 0, 1, 1, 2, 2, 3, 3, 4]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Trace {
    netlist: Netlist,
    nets: Vec<Net>,
    values: Vec<Vec<u64>>,
}

impl Trace {
    /// Number of samples, one more than clocks.
    #[must_use]
    pub fn len(&self) -> usize {
        self.values.first().map_or(0, Vec::len)
    }

    /// Nothing was recorded.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Bits of every sample of a signal, by its name, its path, or the end of its path.
    ///
    /// # Errors
    /// No signal or several have this name.
    pub fn bits(&self, signal: &str) -> Result<&[u64], SignalError> {
        Ok(self.find(signal)?.1)
    }

    /// Every sample of a signal as the number that it is declared to hold: unsigned, in two's complement, or in decimal
    /// digits.
    ///
    /// # Errors
    /// No signal or several have this name, or a value exceeds 64 bits.
    pub fn i64(&self, signal: &str) -> Result<Vec<i64>, SignalError> {
        let (named, column) = self.find(signal)?;
        let (width, reading) = (self.netlist.width(named.net), named.format.reading());
        let read = |&value: &u64| {
            let number = reading.number(width, value);
            i64::try_from(number).map_err(|_| SignalError(format!("{signal} is {number}, which exceeds 64 bits")))
        };
        column.iter().map(read).collect()
    }

    /// The samples of a signal as digits in groups of four: 0, 1, and - for -1.
    ///
    /// # Errors
    /// No signal or several have this name, or one of its values is another.
    pub fn row(&self, signal: &str) -> Result<String, SignalError> {
        let mut row = String::new();
        for (clock, value) in self.i64(signal)?.into_iter().enumerate() {
            if clock > 0 && clock % 4 == 0 {
                row.push('_');
            }
            row.push(match value {
                0 => '0',
                1 => '1',
                -1 => '-',
                other => {
                    return Err(SignalError(format!(
                        "{signal} is {other} at clock {clock}; a row shows 0, 1 and -1: ask for its numbers"
                    )));
                }
            });
        }
        Ok(row)
    }

    fn find(&self, signal: &str) -> Result<(&NamedNet, &[u64]), SignalError> {
        let named = net_named(&self.netlist, signal)?;
        if named.is_wide() {
            let bits = self.netlist.bits(named.nets());
            return Err(SignalError(format!("{signal} has {bits} bits, which exceeds 64 bits: see it in a wave")));
        }
        let unseen = || SignalError(format!("{signal} is not recorded"));
        let column = self.nets.iter().position(|seen| *seen == named.net).ok_or_else(unseen)?;
        Ok((named, &self.values[column]))
    }
}
