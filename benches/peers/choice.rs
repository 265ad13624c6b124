//! What is measured: the words of the command line, and the tools that it needs, all looked at before the first run.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::contender::first_line;
use crate::sections::{FULL, MOST_CELLS, QUICK, SECTIONS, Section, Sizes};
use crate::unit::MODELS;
use crate::{Fallible, cores};

/// Sections to run, in order, and how much of them.
pub(crate) struct Choice {
    pub(crate) sections: Vec<&'static Section>,
    pub(crate) sizes: Sizes,
    /// What is left out, and why.
    pub(crate) notes: Vec<String>,
}

impl Choice {
    /// Reads the words after `--`; those that are no section, model or flag are refused.
    pub(crate) fn of(words: &[String]) -> Fallible<Choice> {
        let (words, svg) = without_svg(words)?;
        let mut sizes = if words.iter().any(|word| word == "--quick") { QUICK } else { FULL };
        let is = |name: &str| words.iter().any(|word| word == name);
        let unknown = |word: &&String| {
            !["--quick", "--large"].contains(&word.as_str())
                && SECTIONS.iter().all(|section| section.name != word.as_str())
                && !MODELS.contains(&word.as_str())
        };
        if let Some(word) = words.iter().find(unknown) {
            return Err(format!("no section or model {word}\n\n{}", help()).into());
        }
        let models: Vec<&'static str> = MODELS.into_iter().filter(|model| is(model)).collect();
        let mut sections: Vec<&Section> = SECTIONS.iter().filter(|section| is(section.name)).collect();
        let mut notes = Vec::new();
        if sections.is_empty() {
            sections.extend(SECTIONS.iter().filter(|section| models.is_empty() || section.by_model));
            let missing =
                sections.iter().any(|section| section.name == "cores").then(cores::folder).and_then(Result::err);
            if let Some(missing) = missing {
                sections.retain(|section| section.name != "cores");
                notes.push(format!("The section `cores` is left out: {missing}."));
            }
        } else if is("cores") {
            cores::folder()?;
        }
        if !models.is_empty() {
            sizes.models = models.into();
        }
        if svg.is_some() && sections.iter().all(|section| section.name != "growth") {
            return Err("--svg draws what the section growth measures".into());
        }
        if is("--large") {
            sizes.cells = MOST_CELLS;
        }
        sizes.svg = svg;
        Ok(Choice { sections, sizes, notes })
    }

    /// Looks for every tool that the sections start.
    pub(crate) fn check_tools(&self) -> Fallible<()> {
        let mut missing = Vec::new();
        for tool in &TOOLS {
            let users: Vec<&str> = self
                .sections
                .iter()
                .filter(|section| section.peers.contains(&tool.peer))
                .map(|section| section.name)
                .collect();
            if !users.is_empty() && !tool.is_there() {
                missing.push(format!(
                    "{} is not installed; {} ({}) needs it",
                    tool.program,
                    tool.peer,
                    users.join(", ")
                ));
            }
        }
        if missing.is_empty() {
            return Ok(());
        }
        Err(format!("{}\n.ci/bench-tools installs all peers on Debian", missing.join("\n")).into())
    }
}

/// The words without `--svg FILE`, and that file.
fn without_svg(words: &[String]) -> Fallible<(Vec<String>, Option<PathBuf>)> {
    let mut words = words.to_vec();
    let Some(at) = words.iter().position(|word| word == "--svg") else { return Ok((words, None)) };
    if at + 1 == words.len() {
        return Err("--svg needs the name of a file".into());
    }
    // A bench is started in the folder of its package, wherever its caller is.
    let file = words.drain(at..at + 2).next_back().unwrap_or_default();
    Ok((words, Some(PathBuf::from(file))))
}

/// What a peer needs.
struct Tool {
    peer: &'static str,
    program: &'static str,
    /// Prints a version, or succeeds at least.
    asked: &'static [&'static str],
}

const TOOLS: [Tool; 9] = [
    Tool { peer: "Icarus", program: "iverilog", asked: &["-V"] },
    Tool { peer: "Icarus", program: "vvp", asked: &["-V"] },
    Tool { peer: "Verilator", program: "verilator", asked: &["--version"] },
    Tool { peer: "Verilator", program: "make", asked: &["--version"] },
    Tool { peer: "Verilator", program: "g++", asked: &["--version"] },
    Tool { peer: "CXXRTL", program: "yosys", asked: &["-V"] },
    Tool { peer: "CXXRTL", program: "yosys-config", asked: &["--datdir"] },
    Tool { peer: "CXXRTL", program: HEADERS, asked: &[] },
    Tool { peer: "CXXRTL", program: "g++", asked: &["--version"] },
];

const HEADERS: &str = "backends/cxxrtl/cxxrtl.h of yosys-dev";

impl Tool {
    fn is_there(&self) -> bool {
        if self.program == HEADERS {
            let data = first_line("yosys-config", &["--datdir"]);
            return Path::new(data.trim()).join("include/backends/cxxrtl/cxxrtl.h").exists();
        }
        Command::new(self.program).args(self.asked).output().is_ok_and(|output| output.status.success())
    }
}

/// What there is.
pub(crate) fn help() -> String {
    let mut text = "cargo bench --bench peers [-- [--quick] [--large] [--svg FILE] [SECTION…] [MODEL…]]\n\n\
                    Sections, all of them without a name (with models alone: those marked *):\n"
        .to_owned();
    for section in &SECTIONS {
        let mark = if section.by_model { '*' } else { ' ' };
        text += &format!("{mark} {:<11} {}\n", section.name, section.about);
    }
    text + &format!(
        "\nModels, all of them without a name: {}\n\n--quick     a smoke test: short runs of {}, one round\n\
         --large     `growth` up to 100,000 cells, which Verilator builds for minutes\n\
         --svg FILE  draws the curves of `growth`\n",
        MODELS.join(", "),
        QUICK.models.join(" and ")
    )
}
