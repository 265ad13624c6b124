//! A netlist with a bench file as a model, which every command takes.

use std::path::Path;

use super::geometry::{Piece, values};
use super::{Bench, BenchError, End, Word, signal};
use crate::models::options::{ON_OVERFLOW, STRICT, Takes, WRAPS};
use crate::models::parts::POSITION;
use crate::models::program::{FASTEST_SPEED, Moves};
use crate::models::registers::{Declared, Rule};
use crate::models::{
    AXES, CurveKind, Described, Hardware, Interpolates, Machine, Model, ModelError, OnOverflow, Plan, Reg, Words, know,
};
use crate::nc::Curve;
use crate::netlist::cells::{NamedNet, Op};
use crate::netlist::{Netlist, Width};

/// Least bits of a position counter, so that a path that errs stays visible.
const POSITION_BITS: u32 = 32;

/// This word of a command line is the path of a netlist, and not the name of a model.
#[must_use]
pub fn is_netlist(word: &str) -> bool {
    word.contains('/') || Path::new(word).extension().is_some_and(|extension| extension == "net")
}

/// The model of the hardware in this netlist, whose ports the bench file describes: the one given, or the one next to the
/// netlist, `F.toml` of `F.net`. A pair of files is read once in a process.
///
/// # Errors
/// A file cannot be read, or what the bench file says does not fit the netlist.
pub fn model(netlist: &str, bench: Option<&Path>) -> Result<&'static Model, BenchError> {
    // As one would give it to a command.
    let name = match bench {
        Some(bench) => format!("{} --bench {}", quoted(netlist), quoted(&bench.display().to_string())),
        None => quoted(netlist),
    };
    if let Ok(known) = crate::models::find(&name) {
        return Ok(known);
    }
    let bench: &'static Bench = Box::leak(Box::new(Bench::read(Path::new(netlist), bench)?));
    let file = bench.file.display();
    Ok(know(Model {
        name: name.leak(),
        title: format!("the netlist {netlist} with the bench file {file}").leak(),
        method: "hardware of one's own",
        source: netlist.to_owned().leak(),
        registers: registers(&bench.netlist, bench.table.as_deref()),
        options: OPTIONS,
        claims: None,
        interpolates: Interpolates::Described(bench),
        hardware: |_, _| {},
    }))
}

/// A path as a shell reads it.
fn quoted(path: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "._-/+,:@%".contains(c);
    if path.chars().all(plain) { path.to_owned() } else { format!("'{}'", path.replace('\'', r"'\''")) }
}

/// What hardware of one's own takes.
static OPTIONS: &[&dyn Takes] = &[
    &ON_OVERFLOW.only(
        Some(OnOverflow::Trap),
        &[
            (OnOverflow::Trap, ": a load word that does not fit is refused"),
            (OnOverflow::Wrap, ": a load word that does not fit is cut"),
        ],
        "what the hardware does is in its source",
    ),
    &STRICT,
    &WRAPS,
];

/// The registers of a netlist, those of the step table first, and the position counters of the harness.
fn registers(netlist: &Netlist, table: Option<&[String]>) -> &'static [&'static dyn Declared] {
    // The leaf where it is found by it alone, and no axis of the harness is called so.
    let name = |named: &NamedNet| match netlist.find(&named.name) {
        Some(found) if found.net == named.net && !AXES.contains(&named.name.as_str()) => named.name.clone(),
        _ => netlist.path(named),
    };
    let shown: Vec<&NamedNet> = table.into_iter().flatten().filter_map(|name| signal(netlist, name).ok()).collect();
    // The values of a word of more than 64 bits are in waves alone.
    let is_register = |named: &&NamedNet| !named.is_wide() && matches!(netlist.cell(named.net).op, Op::Register { .. });
    let others = netlist.names.iter().filter(is_register).filter(|named| shown.iter().all(|own| own.net != named.net));
    let declared = |named: &NamedNet, column: bool| -> &'static dyn Declared {
        let about = netlist.line_of(named.net).unwrap_or_else(|| "a register of the netlist".to_owned());
        let register = Reg::new(name(named).leak(), Rule::Planned("as in the source"), about.leak());
        let register = if named.format.is_signed() { register.signed() } else { register };
        Box::leak(Box::new(if column { register } else { register.hidden() }))
    };
    let of_table = shown.iter().map(|named| declared(named, true));
    let all = of_table.chain(others.map(|named| declared(named, table.is_none())));
    let position: &'static dyn Declared = &POSITION;
    all.chain([position]).collect::<Vec<_>>().leak()
}

impl Bench {
    /// The registers, each with its width.
    fn widths<'a>(&'a self, model: &'a Model) -> impl Iterator<Item = (&'static str, u32)> + 'a {
        let names = model.rows().flat_map(|row| row.names(1));
        names.filter_map(|name| Some((*name, self.netlist.width(self.netlist.find(name)?.net).get())))
    }

    /// Fixes the registers, and position counters for the places that each axis comes to, in BLU.
    pub(super) fn planned(&self, plan: &mut Plan, reach: impl Iterator<Item = Vec<i64>>) -> Result<(), ModelError> {
        let model = crate::models::find(plan.model())?;
        for (name, bits) in self.widths(model) {
            plan.set(Reg::new(name, Rule::Planned("as in the source"), ""), bits);
        }
        for (axis, places) in reach.enumerate() {
            let needed = places.into_iter().map(|place| Width::needed_signed(place.into())).max().unwrap_or(1);
            plan.set(POSITION.of(axis), (needed + 1).max(POSITION_BITS));
        }
        // Nothing is known of its pauses: only a machine at rest, or back where it was, is one that has stalled.
        plan.stall_clocks = u64::MAX;
        plan.step_clocks = None;
        Ok(())
    }

    /// The words of every block of a geometry, but for the position; `remedy` for one that does not fit.
    pub(super) fn loaded(
        &self,
        hardware: &Hardware,
        geometry: Piece<'_>,
        speed: u64,
        remedy: &str,
    ) -> Result<Vec<Words>, ModelError> {
        let remedy = match hardware.get(&ON_OVERFLOW) {
            OnOverflow::Wrap => None,
            _ => Some(format!("{remedy}; --on-overflow wrap cuts it")),
        };
        let pieces = if self.splits { geometry.split() } else { vec![geometry] };
        let words = |piece: &Piece<'_>| {
            let values = values(piece, speed);
            let mut words = Words::new();
            for loaded in &self.loads {
                words = words.set_input(loaded.word.name, self.value(&loaded.word, &values, remedy.as_deref())?);
            }
            let End::Clocks { word } = &self.end else { return Ok(words) };
            match self.value(word, &values, Some("give another expression"))? {
                0 => {
                    let (file, text) = (self.file.display(), &word.text);
                    Err(ModelError::Widths(format!("{file}: clocks = {text} is 0: a block takes 1 or more")))
                }
                clocks => Ok(words.set_input(word.name, clocks)),
            }
        };
        pieces.iter().map(words).collect()
    }

    /// A word for a geometry, which must fit where there is a remedy for one that does not.
    fn value(&self, word: &Word, values: &[i128], remedy: Option<&str>) -> Result<i128, ModelError> {
        let Word { name, expression, text, width, reading, .. } = word;
        let wrong = |why: String| ModelError::Widths(format!("{}: {name} = {text}: {why}", self.file.display()));
        let value = expression.value(values).map_err(wrong)?;
        match remedy {
            Some(remedy) if word.bits > width.get() && !word.holds(value) => {
                let bits = word.bits;
                Err(wrong(format!("{value} does not fit in the {bits} bits of its input: {remedy}")))
            }
            Some(remedy) if word.bits <= width.get() && reading.bits(*width, value).is_none() => {
                let (least, greatest) = width.range(reading.is_signed());
                Err(wrong(format!("{value} does not fit in its {width}, {least} to {greatest}: {remedy}")))
            }
            _ => Ok(word.own_part(value)),
        }
    }
}

impl Word {
    /// A number fits in an input of more than 64 bits, of which this is a part.
    fn holds(&self, value: i128) -> bool {
        let is_signed = self.of_signed;
        let above = value >> (self.bits - u32::from(is_signed)).min(i128::BITS - 1);
        above == 0 || is_signed && above == -1
    }

    /// The part of a number that its net takes.
    fn own_part(&self, value: i128) -> i128 {
        let low = self.part * Width::MAX.get();
        let part = value >> low.min(i128::BITS - 1);
        if low + self.width.get() < self.bits { part & i128::from(self.width.mask()) } else { part }
    }
}

impl Described for Bench {
    fn curve(&self) -> CurveKind {
        self.curve
    }

    fn plan(&self, curve: &Curve, plan: &mut Plan) -> Result<(), ModelError> {
        if !matches!(curve, Curve::Line(_) | Curve::Arc(_)) {
            let (model, takes) = (plan.model(), "lines, and arcs in the plane");
            return Err(ModelError::Curve { model, takes, given: "another curve".to_owned() });
        }
        if curve.axes() > self.axes.len().max(2) {
            let (model, axes) = (plan.model(), self.axes.len());
            return Err(ModelError::Widths(format!(
                "{model}: the line has {} axes, the hardware {axes}: give a --to of {axes}, or describe the others in \
                 {} as [axis.{}]",
                curve.axes(),
                self.file.display(),
                AXES[axes],
            )));
        }
        let reach = |axis: usize| match curve {
            Curve::Arc(arc) => {
                let [center, radius] = [arc.center()[axis], ceiling(arc.radius())];
                vec![center.saturating_sub(radius), center.saturating_add(radius), curve.from()[axis]]
            }
            _ => vec![curve.from()[axis], curve.to()[axis]],
        };
        self.planned(plan, (0..curve.axes()).map(reach))
    }

    fn machine(&self, hardware: &Hardware) -> Result<Machine, ModelError> {
        self.harnessed(hardware)
    }

    fn words(&self, hardware: &Hardware, curve: &Curve) -> Result<Vec<Words>, ModelError> {
        let remedy = "give a smaller geometry or another expression";
        let mut all = self.loaded(hardware, Piece::whole(curve), FASTEST_SPEED, remedy)?;
        if let Some(words) = all.first_mut() {
            let from = curve.from().iter().enumerate();
            *words = from.fold(std::mem::take(words), |words, (axis, &from)| words.set(POSITION.of(axis), from));
        }
        Ok(all)
    }

    fn moves(&self) -> &dyn Moves {
        self
    }
}

/// The whole number not below a length in BLU.
#[expect(clippy::cast_possible_truncation, reason = "a cast saturates")]
fn ceiling(length: f64) -> i64 {
    length.ceil() as i64
}
