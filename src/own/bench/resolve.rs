//! A bench file against its netlist: names become nets, texts become numbers and expressions.

use std::path::Path;

use toml::Spanned;

use super::expression::Expression;
use super::file::{Axis, Count, Curves, File, Split, Strobe, Value};
use super::geometry::{SPEED, names, of_arcs};
use super::{Bench, BenchError, End, Loaded, Pulses, Reset, Wire, Word, next_to, signal, word};
use crate::models::{AXES, CurveKind};
use crate::netlist::bits::{Bits, Reading};
use crate::netlist::cells::{NamedNet, Op};
use crate::netlist::{Net, Netlist, Width, did_you_mean};
use crate::own::file::{read_netlist, read_text};
use crate::own::stimulus::{self, parsed};

/// Most bytes of a bench file.
const MOST_BYTES: u64 = 1 << 20;
/// Most names that a message lists.
const MOST_LISTED: usize = 24;
/// Bits of the counter of clocks of a block.
const CLOCK_BITS: u32 = 62;

/// Inputs that have a driver, each with the key that says so.
type Driven = Vec<(Net, String)>;
/// A constant on an input: its name, and the values of its nets.
type Constant<'f> = (&'f str, Vec<(Net, u64)>);

/// What is wrong with a value, in words; its place is added where it is known.
type Refusal = String;

pub(super) struct Resolver<'a> {
    pub(super) netlist: &'a Netlist,
    pub(super) names: Vec<String>,
    pub(super) file: String,
    pub(super) text: &'a str,
}

/// The text of a bench file, and what is written in it.
pub(super) fn read_form(file: &Path) -> Result<(String, File), BenchError> {
    let text = read_text(file, MOST_BYTES)?;
    let form = toml::from_str(&text).map_err(|error: toml::de::Error| {
        let message = error.to_string().trim_end().to_owned();
        BenchError::Form { file: file.display().to_string(), message }
    })?;
    Ok((text, form))
}

impl Bench {
    /// The bench of a netlist: the file given, or the one next to it.
    ///
    /// # Errors
    /// A file cannot be read, or what it says does not fit the netlist.
    pub(super) fn read(netlist: &Path, bench: Option<&Path>) -> Result<Bench, BenchError> {
        let file = bench.map_or_else(|| next_to(netlist), Path::to_owned);
        let design = read_netlist(netlist)?;
        if bench.is_none() && !file.exists() {
            let [netlist, bench] = [netlist, file.as_path()].map(|path| path.display().to_string());
            return Err(BenchError::Missing { netlist, bench });
        }
        let (text, form) = read_form(&file)?;
        let name = file.display().to_string();
        let netlist = design.netlist();
        Resolver { netlist, names: names(), file: name, text: &text }.bench(form, file)
    }
}

impl Resolver<'_> {
    /// The error of a value at this place of the file.
    fn at<T>(&self, place: &Spanned<T>, message: Refusal) -> BenchError {
        let before = self.text.get(..place.span().start).unwrap_or_default();
        BenchError::Value { file: self.file.clone(), line: before.matches('\n').count() + 1, message }
    }

    /// The error of what is missing.
    pub(super) fn missing(&self, message: &str) -> BenchError {
        BenchError::Form { file: self.file.clone(), message: message.to_owned() }
    }

    fn bench(&self, form: File, file: std::path::PathBuf) -> Result<Bench, BenchError> {
        if let Some(clock) = &form.clock
            && signal(self.netlist, clock.get_ref()).is_ok()
        {
            let message = format!(
                "clock = \"{}\" is a signal of the netlist, and its clock is none: leave the key out, or name the clock of \
                 the source",
                clock.get_ref()
            );
            return Err(self.at(clock, message));
        }
        let axes = self.axes(&form)?;
        let mut driven: Driven = Vec::new();
        let reset = form.reset.as_ref().map(|reset| self.reset(reset, &mut driven)).transpose()?;
        let constants = self.constants(&form, &mut driven)?.into_iter().flat_map(|(_, nets)| nets).collect();
        self.assumed(&form)?;
        let mut loads = Vec::new();
        for (name, value) in &form.load {
            let loaded = self.loaded(name, value.get_ref(), &mut driven);
            loads.extend(loaded.map_err(|message| self.at(value, format!("load {name}: {message}")))?);
        }
        let start = form.start.as_ref().map(|name| self.start(name, &mut driven)).transpose()?;
        let end = self.end(&form)?;
        let step = form.step.as_ref().map(|name| self.wire(name.get_ref()).map_err(|message| self.at(name, message)));
        let step = step.transpose()?;
        if start.is_none() && form.strobe == Strobe::Level {
            return Err(self.missing("strobe = \"level\" says how long `start` is 1, which is not given: add start"));
        }
        for name in form.table.iter().flat_map(|table| table.get_ref()) {
            let table = form.table.as_ref();
            let refused = |message| table.map_or_else(|| self.missing(""), |table| self.at(table, message));
            self.named(name).map_err(|message| refused(format!("table: {message}")))?;
        }
        let curve = self.curve(&form, &loads, &end, axes.len())?;
        let (splits, reads_speed) = (self.splits(&form, curve)?, self.reads_any(&loads, &end, SPEED));
        let (netlist, table) = (self.netlist.clone(), form.table.map(Spanned::into_inner));
        let (strobe, strict, wraps) = (form.strobe, form.strict, form.wraps);
        Ok(Bench {
            file,
            netlist,
            curve,
            splits,
            reads_speed,
            reset,
            constants,
            loads,
            start,
            strobe,
            end,
            step,
            table,
            axes,
            strict,
            wraps,
        })
    }

    /// The signal of this name.
    fn named(&self, name: &str) -> Result<&NamedNet, Refusal> {
        signal(self.netlist, name).map_err(|message| {
            let of_top = self.netlist.names.iter().filter(|named| named.scope.index() == 0);
            let mut known: Vec<&str> = of_top.map(|named| named.name.as_str()).collect();
            let more = if known.len() > MOST_LISTED { ", …" } else { "" };
            known.truncate(MOST_LISTED);
            format!("{message}; it has {}{more}", known.join(", "))
        })
    }

    /// The input of this name, which nothing else drives.
    fn input(&self, name: &str, driven: &mut Driven, by: &str) -> Result<&NamedNet, Refusal> {
        let is_input = |named: &&NamedNet| named.nets().all(|net| matches!(self.netlist.cell(net).op, Op::Input));
        let found = word(self.netlist, name).ok().filter(is_input).ok_or_else(|| {
            let inputs = self.netlist.names.iter().filter(is_input).map(|named| named.name.as_str());
            let inputs: Vec<&str> = inputs.collect();
            let hint = did_you_mean(name, inputs.iter().copied());
            format!("there is no input '{name}'{hint}; the inputs are: {}", inputs.join(", "))
        })?;
        if let Some((_, other)) = driven.iter().find(|(net, _)| *net == found.net) {
            return Err(format!("the input '{name}' is driven by `{other}` already: leave one of them out"));
        }
        driven.push((found.net, by.to_owned()));
        Ok(found)
    }

    /// A 1-bit signal, or its complement, which has a ! in front.
    fn wire(&self, text: &str) -> Result<Wire, Refusal> {
        let (inverted, name) = inverted(text);
        let net = self.one_bit(self.named(name)?, name)?;
        Ok(Wire { net, inverted })
    }

    fn one_bit(&self, named: &NamedNet, name: &str) -> Result<Net, Refusal> {
        match self.netlist.bits(named.nets()) {
            1 => Ok(named.net),
            bits => Err(format!("'{name}' has {bits} bits where a signal of 1 bit is needed")),
        }
    }

    pub(super) fn reset(&self, reset: &super::file::Reset, driven: &mut Driven) -> Result<Reset, BenchError> {
        let name = reset.port.get_ref();
        let input = self.input(name, driven, "reset").and_then(|named| self.one_bit(named, name));
        let input = input.map_err(|message| self.at(&reset.port, format!("reset: {message}")))?;
        let active = match reset.active.get_ref() {
            0 => false,
            1 => true,
            other => return Err(self.at(&reset.active, format!("reset: active is {other}: give 0 or 1"))),
        };
        let clocks = *reset.clocks.get_ref();
        if clocks > 1 << 20 {
            return Err(
                self.at(&reset.clocks, format!("reset: {clocks} clocks are too many: give at most {}", 1 << 20))
            );
        }
        Ok(Reset { input, active, clocks })
    }

    /// The constants on inputs, each with the values of its nets.
    pub(super) fn constants<'f>(&self, form: &'f File, driven: &mut Driven) -> Result<Vec<Constant<'f>>, BenchError> {
        let constant = |(name, value): (&'f String, &Spanned<Value>)| {
            let constant = self.constant(name, value.get_ref(), driven);
            let constant = constant.map_err(|message| self.at(value, format!("set {name}: {message}")))?;
            Ok((name.as_str(), constant))
        };
        form.set.iter().map(constant).collect()
    }

    fn constant(&self, name: &str, value: &Value, driven: &mut Driven) -> Result<Vec<(Net, u64)>, Refusal> {
        let named = self.input(name, driven, "set")?;
        let text = value.text();
        if named.is_wide() {
            let mut values = Vec::new();
            // It has its own words for the place.
            stimulus::value(self.netlist, named, name, text.trim(), "value", &mut values)
                .map_err(|error| error.to_string())?;
            return Ok(named.nets().zip(values).collect());
        }
        let width = self.netlist.width(named.net);
        let number = parsed(text.trim()).ok_or_else(|| format!("'{text}' is not a number: give 12, 0x1f or 0b101"))?;
        let bits =
            Bits::exact(width, number, number < 0).ok_or_else(|| does_not_fit(&text, width, named.format.reading()))?;
        Ok(vec![(named.net, bits.value())])
    }

    /// The signals that are assumed to be 1, as they are written.
    pub(super) fn assumed<'f>(&self, form: &'f File) -> Result<Vec<(&'f str, Wire)>, BenchError> {
        let Some(assume) = &form.assume else { return Ok(Vec::new()) };
        let wire = |text: &'f String| {
            let wire = self.wire(text).map_err(|message| self.at(assume, format!("assume: {message}")))?;
            Ok((text.as_str(), wire))
        };
        assume.get_ref().iter().map(wire).collect()
    }

    fn loaded(&self, name: &str, value: &Value, driven: &mut Driven) -> Result<Vec<Loaded>, Refusal> {
        let named = self.input(name, driven, "load")?;
        let (reading, bits) = (named.format.reading(), self.netlist.bits(named.nets()));
        let mut loaded = Vec::new();
        for (part, input) in (0..).zip(named.nets()) {
            let width = self.netlist.width(input);
            let low = part * Width::MAX.get();
            let (path, reading) = match (named.is_wide(), low + width.get() < bits) {
                (false, _) => (format!("load.{name}"), reading),
                // Of what is not the top of a word the sign is above.
                (true, true) => (format!("load.{name}[{}:{low}]", low + width.get() - 1), Reading::Unsigned),
                (true, false) => (format!("load.{name}[{}:{low}]", bits - 1), reading),
            };
            let of_signed = named.format.reading().is_signed();
            let word = Word { bits, of_signed, part, ..self.word(&path, value, width, reading)? };
            loaded.push(Loaded { input, word });
        }
        Ok(loaded)
    }

    fn word(&self, name: &str, value: &Value, width: Width, reading: Reading) -> Result<Word, Refusal> {
        let text = value.text();
        let expression = Expression::parse(&text, &self.names).map_err(|why| format!("'{text}': {why}"))?;
        let (name, bits) = (name.to_owned().leak(), width.get());
        Ok(Word { name, expression, text, width, reading, bits, of_signed: reading.is_signed(), part: 0 })
    }

    fn start(&self, name: &Spanned<String>, driven: &mut Driven) -> Result<Wire, BenchError> {
        let text = name.get_ref();
        let mut wire = || {
            let (inverted, port) = inverted(text);
            let net = self.one_bit(self.input(port, driven, "start")?, port)?;
            Ok(Wire { net, inverted })
        };
        wire().map_err(|message: Refusal| self.at(name, format!("start: {message}")))
    }

    fn end(&self, form: &File) -> Result<End, BenchError> {
        match (&form.done, &form.clocks) {
            (Some(name), None) => {
                let wire = self.wire(name.get_ref());
                wire.map(End::Done).map_err(|message| self.at(name, format!("done: {message}")))
            }
            (None, Some(value)) => {
                // A counter of many bits, not of many gates.
                let width = Width::new(CLOCK_BITS.into()).unwrap_or(Width::MAX);
                let word = self.word("clocks", value.get_ref(), width, Reading::Unsigned);
                let word = word.map_err(|message| self.at(value, format!("clocks: {message}")))?;
                Ok(End::Clocks { word })
            }
            (None, None) => Err(self.missing(
                "nothing says when a block has ended: add done = \"NAME\", a signal that is 1 then, or clocks = \"…\", how many \
                 clocks it takes",
            )),
            (Some(_), Some(clocks)) => {
                Err(self.at(clocks, "done and clocks both say when a block has ended: leave one of them out".to_owned()))
            }
        }
    }

    fn axes(&self, form: &File) -> Result<Vec<Pulses>, BenchError> {
        if let Some((name, axis)) = form.axis.iter().find(|(name, _)| !AXES.contains(&name.as_str())) {
            let known = AXES.join(", ");
            return Err(self.at(axis, format!("there is no axis '{name}': the axes are {known}")));
        }
        let mut axes = Vec::new();
        for (index, letter) in AXES.iter().enumerate() {
            let Some(axis) = form.axis.get(*letter) else { continue };
            if axes.len() < index {
                let missing = AXES[axes.len()];
                return Err(
                    self.at(axis, format!("there is an axis {letter}, but no axis {missing}: add [axis.{missing}]"))
                );
            }
            let pulses = self.pulses(axis.get_ref());
            axes.push(pulses.map_err(|message| self.at(axis, format!("axis {letter}: {message}")))?);
        }
        let own = axes.len();
        if own == 0 {
            return Err(self.missing(
                "it does not say how an axis pulses: add [axis.x] and others, each with step and direction, pulse, up and \
                 down, quadrature, or position",
            ));
        }
        axes.resize(own.max(2), Pulses::Still);
        if let Some(most) = &form.max_axes {
            let count = *most.get_ref();
            if !(own.min(2) as u64..=own as u64).contains(&count) {
                let give = if own < 2 { "1".to_owned() } else { format!("2 to {own}") };
                let message = format!("max_axes = {count}: give {give}, as many as there are [axis.…]");
                return Err(self.at(most, message));
            }
            axes.truncate(usize::try_from(count).unwrap_or(own).max(2));
        }
        Ok(axes)
    }

    fn pulses(&self, axis: &Axis) -> Result<Pulses, Refusal> {
        let direction = match (&axis.direction, &axis.negative) {
            (Some(_), Some(_)) => return Err("direction and negative are the same: leave one of them out".to_owned()),
            (own, other) => own.as_ref().or(other.as_ref()),
        };
        let edges = axis.count.map(|count| count == Count::Edges);
        let of_strobe = |usual: bool| edges.unwrap_or(usual);
        let strobe = |name: &String, usual: bool| -> Result<Pulses, Refusal> {
            let negative = direction.map(|name| self.wire(name)).transpose()?;
            Ok(Pulses::Strobe { pulse: self.wire(name)?, negative, edges: of_strobe(usual) })
        };
        let alone = |pulses: Pulses| match (direction, edges) {
            (Some(_), _) => Err("its direction is in the pulses: leave out direction or negative".to_owned()),
            (_, Some(_)) => Err("count is for step, pulse, and up and down: leave it out".to_owned()),
            _ => Ok(pulses),
        };
        match (&axis.step, &axis.pulse, (&axis.up, &axis.down), &axis.quadrature, &axis.position) {
            (Some(name), None, (None, None), None, None) => strobe(name, true),
            (None, Some(name), (None, None), None, None) => {
                let net = self.named(inverted(name).1)?.net;
                if self.netlist.width(net).get() > 1 { alone(Pulses::Signed(net)) } else { strobe(name, false) }
            }
            (None, None, (Some(up), Some(down)), None, None) => {
                if direction.is_some() {
                    return Err("up and down have their directions: leave out direction or negative".to_owned());
                }
                Ok(Pulses::UpDown { up: self.wire(up)?, down: self.wire(down)?, edges: of_strobe(true) })
            }
            (None, None, (None, None), Some([a, b]), None) => alone(Pulses::Quadrature([self.wire(a)?, self.wire(b)?])),
            (None, None, (None, None), None, Some(name)) => alone(Pulses::Position(self.named(name)?.net)),
            _ => Err("give one of step, pulse, up and down, quadrature = [\"a\", \"b\"], or position".to_owned()),
        }
    }

    /// Arcs are split where they cross an axis.
    fn splits(&self, form: &File, curve: CurveKind) -> Result<bool, BenchError> {
        let Some(split) = &form.split else { return Ok(false) };
        match (*split.get_ref(), curve) {
            (Split::Quadrants, CurveKind::Line { .. }) => Err(self.at(
                split,
                "lines have no quadrants to be split at: leave split out, or give curves = \"arcs\" or \"both\""
                    .to_owned(),
            )),
            (split, _) => Ok(split == Split::Quadrants),
        }
    }

    /// An expression reads this number.
    fn reads_any(&self, loads: &[Loaded], end: &End, name: &str) -> bool {
        let index = self.names.iter().position(|known| known == name).unwrap_or(usize::MAX);
        expressions(loads, end).any(|word| word.expression.reads(index))
    }

    /// The curves that it interpolates: as it says, or arcs where a word is of an arc alone.
    fn curve(&self, form: &File, loads: &[Loaded], end: &End, axes: usize) -> Result<CurveKind, BenchError> {
        let of_arc = of_arcs().into_iter().find(|name| self.reads_any(loads, end, name));
        let reads_kind = self.reads_any(loads, end, "arc");
        let arcs = CurveKind::Arc;
        let (lines, both) = (CurveKind::Line { max_axes: axes }, CurveKind::Move);
        match (form.curves.as_ref(), of_arc) {
            (None, _) if reads_kind => Ok(both),
            (None, None) => Ok(lines),
            (None, Some(_)) => Ok(arcs),
            (Some(given), of_arc) => match (given.get_ref(), of_arc) {
                (Curves::Lines, Some(name)) => Err(self
                    .at(given, format!("lines have no {name}, which an expression reads: give \"arcs\" or \"both\""))),
                (Curves::Lines, None) => Ok(lines),
                (Curves::Arcs, _) => Ok(arcs),
                (Curves::Both, _) => Ok(both),
            },
        }
    }
}

/// The words that are computed.
fn expressions<'a>(loads: &'a [Loaded], end: &'a End) -> impl Iterator<Item = &'a Word> {
    let end = match end {
        End::Clocks { word } => Some(word),
        End::Done(_) => None,
    };
    loads.iter().map(|loaded| &loaded.word).chain(end)
}

/// Whether a name has a ! in front, and the name.
fn inverted(text: &str) -> (bool, &str) {
    let name = text.trim().strip_prefix('!');
    (name.is_some(), name.unwrap_or(text).trim())
}

fn does_not_fit(text: &str, width: Width, reading: Reading) -> Refusal {
    let (least, greatest) = width.range(reading.is_signed());
    format!("{text} does not fit in its {width}: give {least} to {greatest}")
}
