//! A comparison in words.

use super::{Comparison, Context, Difference, Divergence, Lengths, Mismatch, Moment};
use crate::read::{Signal, ValueKind};
use std::fmt::{self, Display, Formatter};

impl Display for Comparison<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let signals = counted(self.signals, "signal");
        let extent = match self.extent {
            Moment::Clock(1) => "over 1 cycle".into(),
            Moment::Clock(cycles) => format!("over {cycles} cycles"),
            time => format!("up to {time}"),
        };
        let Some(divergence) = &self.divergence else { return write!(f, "same: {signals} {extent}") };
        let [a, b] = self.waves;
        write!(f, "A: {a}\nB: {b}\n\n{divergence}\ncompared: {signals} {extent}")
    }
}

/// Every line ends in a line break.
impl Display for Divergence<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.differences.split_first() {
            Some((first, others)) => {
                writeln!(f, "first divergence: {first}")?;
                write!(f, "\n{}", self.context)?;
                if !others.is_empty() {
                    writeln!(f, "\n{} more, each where it diverges first:", counted(others.len(), "signal"))?;
                }
                others.iter().try_for_each(|other| other.line(f))?;
            }
            None => writeln!(f, "no value differs in what both have, but:")?,
        }
        if !self.differences.is_empty() && (!self.mismatches.is_empty() || self.lengths.is_some()) {
            writeln!(f)?;
        }
        self.mismatches.iter().try_for_each(|mismatch| writeln!(f, "{mismatch}"))?;
        if self.mismatches.iter().any(|m| matches!(m, Mismatch::OnlyInA(_) | Mismatch::OnlyInB(_))) {
            writeln!(f, "(--map a=b pairs signals that are named differently, --ignore GLOB leaves some out)")?;
        }
        self.lengths.map_or(Ok(()), |lengths| writeln!(f, "{lengths}"))
    }
}

impl Difference<'_> {
    fn names(&self) -> String {
        let mut names = self.signal.path.clone();
        if self.signal.path != self.path_b {
            names.push_str(&format!(" (in B {})", self.path_b));
        }
        for alias in &self.aliases {
            names.push_str(&format!(" = {alias}"));
        }
        names
    }

    fn line(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f, "  {}: {}: A {}, B {}", self.at, self.names(), self.a, self.b)
    }
}

/// Three lines: the moment and the names, the value in A, the value in B.
impl Display for Difference<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let [time_a, time_b] = match &self.times {
            Some(times) => times.each_ref().map(|time| format!("   clock begins at {time}")),
            None => [String::new(), String::new()],
        };
        let Self { at, a, b, .. } = self;
        write!(f, "{at}, signal {}\n  A  {a}{time_a}\n  B  {b}{time_b}", self.names())
    }
}

impl Display for Mismatch<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Mismatch::OnlyInA(signal) => write!(f, "only in A: {}", signal.path),
            Mismatch::OnlyInB(signal) => write!(f, "only in B: {}", signal.path),
            Mismatch::Width(a, b) | Mismatch::Kind(a, b) => {
                let what = if matches!(self, Mismatch::Width(..)) { "width" } else { "kind" };
                write!(f, "{what} differs: {}: {} in A, {} in B", a.path, type_of(a), type_of(b))
            }
        }
    }
}

fn type_of(signal: &Signal) -> String {
    match signal.kind {
        ValueKind::Unsigned | ValueKind::Signed => counted(signal.width as usize, "bit"),
        ValueKind::Real => "real".into(),
        ValueKind::Text => "string".into(),
        ValueKind::Event => "event".into(),
    }
}

impl Display for Lengths {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match (self.a, self.b) {
            (Moment::Clock(a), Moment::Clock(b)) => write!(f, "length differs: {a} cycles in A, {b} in B"),
            (a, b) => write!(f, "length differs: A ends at {a}, B at {b}"),
        }
    }
}

impl Display for Moment {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match *self {
            Moment::Clock(cycle) => write!(f, "clock {cycle}"),
            Moment::Time { count, unit: Some(unit) } => f.write_str(&unit.show(count)),
            Moment::Time { count, unit: None } => write!(f, "#{count}"),
        }
    }
}

/// A table: one line for each row, two columns for each signal; `<` marks a row in which a signal differs.
impl Display for Context<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let mut lines: Vec<Vec<String>> = Vec::new();
        let mut head = vec![String::new()];
        head.extend(self.signals.iter().flat_map(|signal| [format!("A {}", signal.leaf()), "B".into()]));
        lines.push(head);
        for row in &self.rows {
            let at = match row.at {
                Moment::Clock(cycle) => cycle.to_string(),
                time => time.to_string(),
            };
            let mut line = vec![at];
            line.extend(row.values.iter().flatten().map(|value| value.cell()));
            if row.values.iter().any(|[a, b]| !a.same(*b)) {
                line.push("<".into());
            }
            lines.push(line);
        }
        let columns = 1 + 2 * self.signals.len();
        let width = |column: usize| lines.iter().filter_map(|line| line.get(column)).map(|c| c.chars().count()).max();
        let widths: Vec<usize> = (0..columns).map(|column| width(column).unwrap_or(0)).collect();
        for line in &lines {
            for (cell, width) in line.iter().zip(&widths) {
                write!(f, "  {cell:>width$}")?;
            }
            let mark = line.get(columns).map_or("", |_| "  <");
            writeln!(f, "{mark}")?;
        }
        Ok(())
    }
}

fn counted(count: usize, thing: &str) -> String {
    format!("{count} {thing}{}", if count == 1 { "" } else { "s" })
}
