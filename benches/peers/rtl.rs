//! Verilog for the peers, with what their C++ mains must know of its ports: written by `stepwave export`, or by hand.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use crate::Fallible;

/// A port that is printed at the end.
#[derive(Clone, Debug)]
pub(crate) struct Shown {
    pub(crate) port: String,
    pub(crate) width: u32,
    /// Two's complement.
    pub(crate) signed: bool,
}

/// A Verilog module with a clock `clk`.
#[derive(Clone, Debug)]
pub(crate) struct Rtl {
    pub(crate) name: String,
    pub(crate) text: String,
    /// Inputs that a block's words are put on, in the order of a line of the file of blocks.
    pub(crate) inputs: Vec<String>,
    /// 1 for the clock that loads the block.
    pub(crate) strobes: Vec<String>,
    pub(crate) done: String,
    /// The register that drives `done`; `None` where logic after registers does.
    pub(crate) done_register: Option<String>,
    pub(crate) result: Vec<Shown>,
    /// Paths of the nets that a wave shows.
    pub(crate) waved: Vec<String>,
}

impl Rtl {
    /// Writes the module as `model.v`, and `ports.h` for a C++ main in which a port is the member that `member` makes
    /// of its name.
    pub(crate) fn write(&self, dir: &Path, top: &str, member: impl Fn(&str) -> String) -> Fallible<()> {
        fs::create_dir_all(dir)?;
        fs::write(dir.join("model.v"), &self.text)?;
        let each = |ports: &[String]| ports.iter().map(|port| format!(" X({})", member(port))).collect::<String>();
        let mut text = format!("#define MODULE \"{}\"\n#define TOP {top}\n", self.name);
        writeln!(text, "#define INPUTS(X){}", each(&self.inputs))?;
        writeln!(text, "#define STROBES(X){}", each(&self.strobes))?;
        writeln!(text, "#define DONE {}", member(&self.done))?;
        writeln!(text, "#define DONE_REGISTER {}", member(self.done_register.as_ref().unwrap_or(&self.done)))?;
        writeln!(text, "#define DONE_IS_LOGIC {}", self.done_register.is_none())?;
        let shown = |shown: &Shown| format!(" X({}, {}, {})", member(&shown.port), shown.width, shown.signed);
        writeln!(text, "#define RESULT(X){}", self.result.iter().map(shown).collect::<String>())?;
        let waved = self.waved.iter().map(|name| format!("\"{name}\", "));
        writeln!(text, "#define WAVED {}", waved.collect::<String>())?;
        Ok(fs::write(dir.join("ports.h"), text)?)
    }
}
