//! The table of hardware options: one declaration of each.
//!
//! An option that is added here is on every command line, in sweeps, titles, reports and the command that repeats a
//! run.

use stepwave_netlist::{OnOverflow, Width};

use super::choices::{Adder, Beats, Brake, Compare, EndPoint, Form, Radix, RampAt, Smooth, System, Weights};
use super::{AnyOption, Gains, Millionths, Named, OptionDef, PerRegister, Preset, Quantity, Shape, StepTiming, Values};

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
            shape: Shape::Text { values: "ways in BLU above 0 such as 8,102.4", some: &[] },
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
            shape: Shape::Text { values: "lengths in BLU such as 0.5,1", some: &[] },
            parse: |text| Millionths::parse(text).map(Some),
            text: |length| text_or_none(length.as_ref()),
        },
        about: "BLU",
        default: None,
    };
    /// Start, drive and stop speed of a ramp.
    SPEED: PerRegister<Quantity> = OptionDef {
        name: "speed",
        help: "Drive speed of a ramp, or start, drive and stop speed by name, in units of its register or with a unit",
        value_name: "SPEED|vs=…,vc=…,ve=…",
        values: Values::Parsed {
            shape: Shape::PerRegister {
                words: &[], least: 1, most: 1 << 54, values: "speeds such as 64..144 or 2400mm/min, or of vs, vc or ve: vs=64,vc=100..144",
            },
            parse: |text| {
                let speeds = PerRegister::parse("speed", text, |word| Quantity::parse(word, 1))?;
                match speeds.single.keys().find(|name| !["vs", "vc", "ve"].contains(&name.as_str())) {
                    Some(name) => Err(format!("unknown speed '{name}': give vs=, vc= or ve=")),
                    None if speeds.all.is_some() && speeds.single.contains_key("vc") => {
                        Err("the drive speed is given two times: leave one of them out".to_owned())
                    }
                    None => Ok(speeds),
                }
            },
            text: |speeds| speeds.text(Quantity::to_string),
        },
        about: "V or vs=V,vc=V,ve=V",
        default: PerRegister::NONE,
    };
    /// Acceleration and deceleration of a ramp.
    ACCEL: Option<Gains> = OptionDef {
        name: "accel",
        help: "Acceleration of a ramp, and its deceleration where that is another: 500mm/s2, or in units of its registers",
        value_name: "A[,D]",
        values: Values::Parsed {
            shape: Shape::Commas,
            parse: |text| or_none(text, Gains::parse),
            text: |gains| text_or_none(gains.as_ref()),
        },
        about: "A or A,D",
        default: None,
    };
    /// Jerk of a ramp.
    JERK: Option<Quantity> = OptionDef {
        name: "jerk",
        help: "Jerk of a ramp, whose speed then goes along an S: 20000mm/s3, or in units of its registers",
        value_name: "J",
        values: Values::Parsed {
            shape: Shape::Numbers { least: 1, most: 1 << 62, none: true, values: "none or jerks such as 4 or 20000mm/s3" },
            parse: |text| or_none(text, |text| Quantity::parse(text, 3)),
            text: |jerk| text_or_none(jerk.as_ref()),
        },
        about: "J: speed along an S (default: none, a trapezoid)",
        default: None,
    };
    /// How a ramp finds where to brake.
    BRAKE: Brake = OptionDef {
        name: "brake",
        help: "How a ramp finds where to brake: by the square of its speed, or by the pulses of its acceleration",
        value_name: "BRAKE",
        values: Values::Words(Brake::ALL),
        about: "",
        default: Brake::Square,
    };
    /// Where the acceleration of a machine is.
    RAMP: RampAt = OptionDef {
        name: "ramp",
        help: "Where a machine that runs programs has its acceleration: before its interpolator (--accel), or after it, for \
               each axis (--smooth, --period)",
        value_name: "RAMP",
        values: Values::Words(RampAt::ALL),
        about: "",
        default: RampAt::Before,
    };
    /// Sampling period of an acceleration after the interpolator.
    PERIOD: Option<u64> = OptionDef {
        name: "period",
        help: "Clocks of a sampling period of --ramp after [default: 1 ms]",
        value_name: "CLOCKS",
        values: Values::Parsed {
            shape: Shape::Numbers { least: 2, most: 1 << 30, none: false, values: "clocks such as 100 or 1000" },
            parse: |text| whole(text, 2, 1 << 30, "a number of clocks").map(Some),
            text: |clocks| text_or_none(clocks.as_ref()),
        },
        about: "clocks of a sampling period of --ramp after (default: 1 ms)",
        default: None,
    };
    /// Acceleration after the interpolator.
    SMOOTH: Smooth = OptionDef {
        name: "smooth",
        help: "Acceleration after the interpolator: the mean of the last periods, or an exponential",
        value_name: "sum=K|exp=S",
        values: Values::Parsed {
            shape: Shape::Text { values: "sum=K or exp=S", some: &["sum=4", "exp=2"] },
            parse: Smooth::parse,
            text: Smooth::to_string,
        },
        about: "sum=4 (default), of up to 64 periods, or exp=S, of up to 16 bits",
        default: Smooth::Sum(4),
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
