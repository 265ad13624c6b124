//! The table of hardware options: the types of their values, and one declaration of each.
//!
//! An option that is added here is on every command line, in sweeps, titles, reports and the command that repeats a
//! run.

use stepwave_netlist::bits::Reading;
use stepwave_netlist::{OnOverflow, Width};

use super::{AnyOption, Millionths, Named, OptionDef, PerRegister, Preset, Shape, StepTiming, Values};

/// What ends a block.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum EndPoint {
    /// One down-counter of the steps of all axes.
    Total,
    /// A down-counter for each axis.
    PerAxis,
    /// A down-counter of the longest axis.
    Longest,
    /// A down-counter of iterations.
    Iterations,
}

impl Named for EndPoint {
    const ALL: &'static [(&'static str, EndPoint)] = &[
        ("total", EndPoint::Total),
        ("per-axis", EndPoint::PerAxis),
        ("longest", EndPoint::Longest),
        ("iterations", EndPoint::Iterations),
    ];
}

/// How the deviation of a line is kept.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Form {
    /// Registers hold |dx| and |dy|; all quadrants look like the first.
    #[default]
    Magnitude,
    /// Registers hold dx and dy; F = dx·y - dy·x.
    Signed,
    /// As `Magnitude`, but F >= 0 steps X whatever the line, as textbooks print it: wrong where the line runs along y.
    Bare,
}

impl Named for Form {
    const ALL: &'static [(&'static str, Form)] =
        &[("magnitude", Form::Magnitude), ("signed", Form::Signed), ("bare", Form::Bare)];
}

/// Clocks of a step that is judged.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Beats {
    /// Judge, feed, compute and compare, one clock each.
    #[default]
    Four,
    /// All at one edge.
    One,
}

impl Named for Beats {
    const ALL: &'static [(&'static str, Beats)] = &[("4", Beats::Four), ("1", Beats::One)];
}

/// Number system of the registers that are added.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Radix {
    /// Binary.
    #[default]
    Binary,
    /// Binary-coded decimal, 4 bits a digit.
    Decimal,
}

impl Radix {
    /// Bits of a digit.
    #[must_use]
    pub fn digit_bits(self) -> u32 {
        match self {
            Radix::Binary => 1,
            Radix::Decimal => 4,
        }
    }
}

impl Named for Radix {
    const ALL: &'static [(&'static str, Radix)] = &[("2", Radix::Binary), ("10", Radix::Decimal)];
}

impl Radix {
    /// How registers of this radix are read.
    #[must_use]
    pub fn reading(self) -> Reading {
        match self {
            Radix::Binary => Reading::Unsigned,
            Radix::Decimal => Reading::Decimal,
        }
    }
}

/// How an integrator adds.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Adder {
    /// All bits in one clock.
    #[default]
    Parallel,
    /// One bit a clock, the lowest first.
    Serial,
}

impl Named for Adder {
    const ALL: &'static [(&'static str, Adder)] = &[("parallel", Adder::Parallel), ("serial", Adder::Serial)];
}

/// The interval weight with which comparison-integral counts a pulse.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Weights {
    /// The sum of the weights before and after the pulse: F is the exact implicit function.
    #[default]
    Mid,
    /// The weight before the pulse.
    Pre,
    /// The weight after the pulse.
    Post,
}

impl Named for Weights {
    const ALL: &'static [(&'static str, Weights)] =
        &[("mid", Weights::Mid), ("pre", Weights::Pre), ("post", Weights::Post)];
}

/// What a counter is compared with to give a pulse.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Compare {
    /// At least the number of steps (`>=`).
    #[default]
    AtLeast,
    /// More than the number of steps (`>`), as early firmware does.
    Greater,
}

impl Named for Compare {
    const ALL: &'static [(&'static str, Compare)] = &[("ge", Compare::AtLeast), ("gt", Compare::Greater)];
}

impl Named for OnOverflow {
    const ALL: &'static [(&'static str, OnOverflow)] =
        &[("trap", OnOverflow::Trap), ("saturate", OnOverflow::Saturate), ("wrap", OnOverflow::Wrap)];
}

/// How the coarse stage of data sampling calculates the travel of a period.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum System {
    /// By the direction in the middle of the period: tangent, cosine, square root.
    #[default]
    Direction,
    /// The extended DDA: by the step factor λ.
    StepFactor,
}

impl Named for System {
    const ALL: &'static [(&'static str, System)] = &[("7m", System::Direction), ("7360", System::StepFactor)];
}

impl System {
    /// The period T in seconds.
    #[must_use]
    pub fn period(self) -> f64 {
        let [seconds, of] = self.period_ratio();
        seconds as f64 / of as f64
    }

    /// The period T as a ratio of whole numbers of seconds: 8 ms, or 10.24 ms.
    pub(crate) fn period_ratio(self) -> [u64; 2] {
        match self {
            System::Direction => [1, 125],
            System::StepFactor => [32, 3125],
        }
    }
}

/// Declares the options, and the list of them in the order of the command line.
macro_rules! options {
    ($($(#[$doc:meta])* $name:ident: $type:ty = $declaration:expr;)*) => {
        $($(#[$doc])* pub static $name: OptionDef<$type> = $declaration;)*

        /// Every option of the catalogue's models, in the order of the command line.
        pub static ALL: &[&'static dyn AnyOption] = &[$(&$name),*];
    };
}

options! {
    /// Widths of registers in bits.
    WIDTH: PerRegister<Width> = OptionDef {
        name: "width",
        help: "Width of all magnitude registers, or of single ones by name [default: the least that holds the geometry]",
        value_name: "N|REGISTER=N,…",
        values: Values::Parsed {
            shape: Shape::PerRegister {
                words: &[], least: 1, most: 64, values: "bits from 1 to 64, such as 8..12 or f=9..11",
            },
            parse: |text| PerRegister::parse("width", text, |word| {
                let bits: u64 = word.parse().map_err(|_| {
                    format!("invalid width '{word}': give a number of bits from 1 to 64, such as 8 or f=9")
                })?;
                Width::new(bits).map_err(|error| error.to_string())
            }),
            text: |widths| widths.text(|width| width.get().to_string()),
        },
        about: "N or REGISTER=N,… (default: the least that holds the geometry)",
        default: PerRegister::NONE,
    };
    /// What remainder registers start from.
    PRESET: PerRegister<Preset> = OptionDef {
        name: "preset",
        help: "Start value of the remainder registers: zero, half, full, a number, or jrx=…,jry=…",
        value_name: "PRESET",
        values: Values::Parsed {
            shape: Shape::PerRegister {
                words: &["zero", "half", "full"],
                least: 0,
                most: i64::MAX.cast_unsigned(),
                values: "zero, half, full or numbers from 0 on, such as 0..15",
            },
            parse: |text| PerRegister::parse("preset", text, Preset::parse),
            text: |presets| presets.text(Preset::to_string),
        },
        about: "zero (default) | half | full | N, or jrx=N,jry=N",
        default: PerRegister::NONE,
    };
    /// Left-shift normalisation.
    NORMALIZE: bool = OptionDef {
        name: "normalize",
        help: "Left-shift normalisation of the integrands",
        value_name: "",
        values: Values::Words(&[("no", false), ("yes", true)]),
        about: "left-shift normalisation (default: none)",
        default: false,
    };
    /// Number system of integrators.
    RADIX: Radix = OptionDef {
        name: "radix",
        help: "Number system of the integrators: binary, or decimal digits of 4 bits",
        value_name: "RADIX",
        values: Values::Words(Radix::ALL),
        about: "",
        default: Radix::Binary,
    };
    /// How integrators add.
    ADDER: Adder = OptionDef {
        name: "adder",
        help: "How integrators add: all bits in a clock, or one bit a clock",
        value_name: "ADDER",
        values: Values::Words(Adder::ALL),
        about: "",
        default: Adder::Parallel,
    };
    /// What ends a block.
    END_POINT: EndPoint = OptionDef {
        name: "end-point",
        help: "What ends a block",
        value_name: "END_POINT",
        values: Values::Words(EndPoint::ALL),
        about: "",
        default: EndPoint::Total,
    };
    /// How the deviation of a line is kept.
    FORM: Form = OptionDef {
        name: "form",
        help: "How the deviation of a line is kept",
        value_name: "FORM",
        values: Values::Words(Form::ALL),
        about: "",
        default: Form::Magnitude,
    };
    /// Weight rule of comparison-integral.
    WEIGHTS: Weights = OptionDef {
        name: "weights",
        help: "Interval weight that counts for a pulse: of the middle, before it, or after it",
        value_name: "WEIGHTS",
        values: Values::Words(Weights::ALL),
        about: "",
        default: Weights::Mid,
    };
    /// Clocks of a step.
    BEATS: Beats = OptionDef {
        name: "beats",
        help: "Clocks of a step",
        value_name: "BEATS",
        values: Values::Words(Beats::ALL),
        about: "",
        default: Beats::Four,
    };
    /// Feed override in percent of the clock.
    OVERRIDE: Option<u64> = OptionDef {
        name: "override",
        help: "Feed override: a pulse multiplier of two decades in front of the clock",
        value_name: "PERCENT",
        values: Values::Parsed {
            shape: Shape::Numbers { least: 1, most: 99, none: true, values: "none or percentages from 1 to 99" },
            parse: |text| or_none(text, |text| {
                let number = text.strip_suffix('%').unwrap_or(text).trim();
                let percent = number.parse().ok().filter(|percent| (1..=99).contains(percent));
                percent.ok_or_else(|| format!(
                    "invalid feed override '{text}': give a percentage from 1 to 99, or leave --override out for 100"
                ))
            }),
            text: |percent| text_or_none(percent.as_ref()),
        },
        about: "1 … 99: percentage of the clock (default: all of it)",
        default: None,
    };
    /// Bits of each unit of a cascaded pulse multiplier.
    CASCADE: Option<Width> = OptionDef {
        name: "cascade",
        help: "Bits of each unit of a cascaded pulse multiplier [default: one unit]",
        value_name: "BITS",
        values: Values::Parsed {
            shape: Shape::Numbers { least: 1, most: 64, none: true, values: "none or bits from 1 to 64" },
            parse: |text| or_none(text, |text| {
                let bits =
                    text.parse().map_err(|_| format!("invalid number of bits '{text}': give one from 1 to 64"))?;
                Width::new(bits).map_err(|error| error.to_string())
            }),
            text: |bits| text_or_none(bits.map(Width::get).as_ref()),
        },
        about: "bits of each unit (default: one unit)",
        default: None,
    };
    /// Comparison of a counter.
    COMPARE: Compare = OptionDef {
        name: "compare",
        help: "Comparison that makes a counter step: ge (>=), or gt (>) as early firmware does",
        value_name: "COMPARE",
        values: Values::Words(Compare::ALL),
        about: "",
        default: Compare::AtLeast,
    };
    /// Bit of a phase accumulator whose changes are steps.
    PICK_OFF: Option<u64> = OptionDef {
        name: "pick-off",
        help: "Bit of the phase accumulator whose changes are steps",
        value_name: "BIT",
        values: Values::Parsed {
            shape: Shape::Numbers { least: 1, most: 62, none: false, values: "bits from 1 to 62" },
            parse: |text| whole(text, 1, 62, "a bit").map(Some),
            text: |bit| text_or_none(bit.as_ref()),
        },
        about: "bit whose changes are steps",
        default: None,
    };
    /// Times of step and direction outputs.
    TIMING: StepTiming = OptionDef {
        name: "timing",
        help: "Clocks of step length and space, direction set-up and hold: length=…,space=…,setup=…,hold=…",
        value_name: "NAME=CLOCKS,…",
        values: Values::Parsed { shape: Shape::Commas, parse: StepTiming::parse, text: StepTiming::to_string },
        about: "length=N,space=N,setup=N,hold=N",
        default: StepTiming::USUAL,
    };
    /// How the coarse stage of data sampling calculates, and its period.
    SYSTEM: System = OptionDef {
        name: "system",
        help: "How the coarse stage of data sampling calculates, and its period: 7m in 8 ms, 7360 in 10.24 ms",
        value_name: "SYSTEM",
        values: Values::Words(System::ALL),
        about: "",
        default: System::Direction,
    };
    /// Bits of the fraction of coarse points.
    FRACTION: Option<u32> = OptionDef {
        name: "fraction",
        help: "Bits of the fraction of coarse points, and of all registers of a free curve",
        value_name: "BITS",
        values: Values::Parsed {
            shape: Shape::Numbers { least: 1, most: 63, none: false, values: "bits such as 8..12" },
            parse: |text| whole(text, 0, u32::MAX.into(), "a number of bits")
                .map(|bits| Some(u32::try_from(bits).unwrap_or(u32::MAX))),
            text: |bits| text_or_none(bits.as_ref()),
        },
        about: "bits of the fraction of coarse points, 8 or more (default: 10)",
        default: None,
    };
    /// Steps of a segment of a free curve, as a power of two.
    DIVISIONS: Option<u64> = OptionDef {
        name: "divisions",
        help: "A segment of a free curve is 2^S steps [default: the least with one pulse of an axis a step at most]",
        value_name: "S",
        values: Values::Parsed {
            shape: Shape::Numbers { least: 1, most: 20, none: false, values: "numbers from 1 to 20" },
            parse: |text| whole(text, 1, 20, "a number of divisions").map(Some),
            text: |divisions| text_or_none(divisions.as_ref()),
        },
        about: "S: a segment is 2^S steps (default: the least with one pulse of an axis a step at most)",
        default: None,
    };
    /// Displacement of a period of data sampling.
    STEP: Option<Millionths> = OptionDef {
        name: "step",
        help: "Way of a period of data sampling, in BLU",
        value_name: "BLU",
        values: Values::Parsed {
            shape: Shape::Text { values: "ways in BLU such as 8,102.4" },
            parse: |text| Millionths::parse(text).map(Some),
            text: |step| text_or_none(step.as_ref()),
        },
        about: "BLU of a period",
        default: None,
    };
    /// How far an arc may be left.
    TOLERANCE: Option<Millionths> = OptionDef {
        name: "tolerance",
        help: "How far an arc may be left, in BLU: by the chords of a coarse stage, and by an end point, whose radius may \
               differ from that of the start by so much more than rounding makes",
        value_name: "BLU",
        values: Values::Parsed {
            shape: Shape::Text { values: "lengths in BLU such as 0.5,1" },
            parse: |text| Millionths::parse(text).map(Some),
            text: |length| text_or_none(length.as_ref()),
        },
        about: "BLU",
        default: None,
    };
    /// What a strict cell does on overflow.
    ON_OVERFLOW: OnOverflow = OptionDef {
        name: "on-overflow",
        help: "What a cell does that must not overflow",
        value_name: "ON_OVERFLOW",
        values: Values::Words(OnOverflow::ALL),
        about: "",
        default: OnOverflow::Trap,
    };
    /// Overflows of hardware of one's own that end a run.
    STRICT: Vec<String> = OptionDef {
        name: "strict",
        help: "Of a netlist of one's own: properties at whose first violation a run ends, by register or path",
        value_name: "GLOB,…",
        values: GLOBS,
        about: "GLOB,…: end the run at their first violation (default: none)",
        default: Vec::new(),
    };
    /// Overflows of hardware of one's own that are meant to be lost.
    WRAPS: Vec<String> = OptionDef {
        name: "wraps",
        help: "Of a netlist of one's own: registers whose carries are meant to be lost, flags in the wave and not events",
        value_name: "GLOB,…",
        values: GLOBS,
        about: "GLOB,…: their carries are meant to be lost (default: none)",
        default: Vec::new(),
    };
}

/// Globs of names, with commas between them that are not in braces.
const GLOBS: Values<Vec<String>> =
    Values::Parsed { shape: Shape::Commas, parse: |text| Ok(globs(text)), text: |globs| globs.join(",") };

fn globs(text: &str) -> Vec<String> {
    let (mut globs, mut depth) = (vec![String::new()], 0_usize);
    for c in text.chars() {
        match c {
            '{' | '[' => depth += 1,
            '}' | ']' => depth = depth.saturating_sub(1),
            _ => {}
        }
        match globs.last_mut() {
            Some(last) if c != ',' || depth > 0 => last.push(c),
            _ => globs.push(String::new()),
        }
    }
    globs.retain(|glob| !glob.trim().is_empty());
    globs
}

/// A value, or `none`.
fn or_none<T>(text: &str, value: impl Fn(&str) -> Result<T, String>) -> Result<Option<T>, String> {
    if text == "none" { Ok(None) } else { value(text).map(Some) }
}

fn text_or_none<T: ToString>(value: Option<&T>) -> String {
    value.map_or_else(|| "none".to_owned(), T::to_string)
}

/// A whole number within limits.
fn whole(text: &str, least: u64, most: u64, what: &str) -> Result<u64, String> {
    let number = text.parse().ok().filter(|number| (least..=most).contains(number));
    number.ok_or_else(|| format!("'{text}' is not {what} from {least} to {most}"))
}
