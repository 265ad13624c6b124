//! Another opinion: an SMT solver that is asked about every geometry of a few bits.

use std::fmt::Write as _;
use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use stepwave_export::{Checking, smt2_asking};
use stepwave_models::{Claims, Model, ModelError, Options};
use stepwave_netlist::{Net, Width};

use super::{Narrower, ProofError, choices_at, hardware_at, largest};
use crate::testbench::Testbench;

/// Most geometries that one question is about.
const MOST: usize = 4096;
/// Bits up to which geometries are listed.
const LISTED: u32 = 7;
/// Most clocks that one question is about.
const DEEPEST: u64 = 2000;
/// Most bytes of what a solver says that are read.
const MOST_SAID: u64 = 1 << 20;

/// A question for a solver.
#[derive(Clone, Debug)]
pub struct Question {
    /// The script, in SMT-LIB 2: `sat` if a register overflows, or a block does not end at its end point.
    pub script: String,
    /// Geometries that it is about: all of them.
    pub geometries: usize,
    /// Clocks that each is given.
    pub clocks: u64,
}

/// What a solver says.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Answer {
    /// There is a violation.
    Sat,
    /// There is none.
    Unsat,
}

/// Why a solver gives no answer.
#[derive(Debug, thiserror::Error)]
pub enum SolverError {
    /// It cannot be started.
    #[error(
        "the solver '{command}' cannot be run: {error}: name one that reads SMT-LIB 2 from its input, such as --solver 'z3 -in'"
    )]
    Start {
        /// The command.
        command: String,
        /// Why.
        error: std::io::Error,
    },
    /// It says nothing in time.
    #[error(
        "the solver '{command}' was stopped after {seconds} s without an answer: give more --solver-seconds, or fewer --bits"
    )]
    Late {
        /// The command.
        command: String,
        /// The limit.
        seconds: u64,
    },
    /// It says something else.
    #[error(
        "the solver '{command}' said '{said}', neither sat nor unsat: name one that reads SMT-LIB 2 from its input, or give fewer --bits"
    )]
    Answer {
        /// The command.
        command: String,
        /// Its first line.
        said: String,
    },
}

fn too_long(k: u32) -> ProofError {
    ProofError::Box(format!(
        "some geometries of {k} bits take more than {DEEPEST} clocks: ask a solver about fewer --bits"
    ))
}

/// The question about every geometry of `k` bits that the model claims something of.
///
/// # Errors
/// There are too many geometries, or their runs are too long, or the hardware cannot be built.
pub fn question(
    model: &'static Model,
    claims: &Claims,
    choices: &Options,
    narrower: &Narrower,
    k: u32,
) -> Result<Question, ProofError> {
    let own = choices_at(model, claims, choices, narrower, k)?;
    // All of them: of more bits there are too many even to list.
    let curves = if k <= LISTED { claims.geometries.curves(k, usize::MAX) } else { Vec::new() };
    if curves.is_empty() || curves.len() > MOST {
        let what = if curves.is_empty() && k <= LISTED {
            "no geometry".to_owned()
        } else {
            format!("more than {MOST} geometries")
        };
        return Err(ProofError::Box(format!("there are {what} of {k} bits to ask a solver about: give other --bits")));
    }
    // At the default widths, so that a narrower register does not cut the runs short.
    let wide = choices_at(model, claims, choices, &Narrower::new(), k)?;
    let hardware = hardware_at(model, claims, &wide, k)?;
    let runs = Testbench::of_hardware(model, hardware)?.run_many(&curves, DEEPEST).map_err(|_| too_long(k))?;
    let clocks = runs.iter().map(|run| run.as_ref().map_or(DEEPEST + 1, |run| run.clocks)).max().unwrap_or(0) + 2;
    if clocks > DEEPEST {
        return Err(too_long(k));
    }
    let bench = Testbench::of_hardware(model, hardware_at(model, claims, &own, k)?)?;
    let machine = bench.machine();
    let words: Vec<String> = bench.load_words().map(str::to_owned).collect();
    let any = bench.of(model, &curves[0]).or_else(|_| bench.of(model, &largest(claims, k)?))?;
    let (driven, held) = any.driven_open(&words)?;
    let mut choice = Vec::new();
    for curve in &curves {
        // A word that does not fit its register: the loader refuses the geometry, and so does the question.
        let words = model.words(bench.hardware(), curve)?;
        let Ok(blocks) = machine.encode(bench.hardware(), &words) else { continue };
        let [block] = &blocks[..] else { continue };
        let end: Vec<(usize, u64)> =
            curve.to().iter().enumerate().map(|(axis, &c)| (axis, c.cast_unsigned())).collect();
        choice.push((block.clone(), end));
    }
    let done = driven.net(machine.done.net);
    let positions: Vec<(Net, Width)> =
        machine.positions.iter().map(|port| (driven.net(port.net), port.width)).collect();
    let comment = [format!("{} with every geometry of {k} bits: {}", model.name, claims.geometries.describe())];
    let checking = Checking { comment: &comment, held: &held };
    let geometries = choice.len();
    let script = smt2_asking(&driven.design, &checking, clocks, |violated, name| {
        let mut text = String::new();
        for (axis, (_, width)) in positions.iter().enumerate() {
            let _ = writeln!(text, "(declare-const wanted{axis} (_ BitVec {}))", width.get());
        }
        let literal = |width: u32, value: u64| {
            let bits: String = (0..width).rev().map(|bit| if value >> bit & 1 == 1 { '1' } else { '0' }).collect();
            format!("#b{bits}")
        };
        text += "(assert (or";
        for (block, end) in &choice {
            text += "\n  (and";
            for &(input, value) in block {
                let width = machine.design.netlist().width(input).get();
                let _ = write!(text, " (= {} {})", name(driven.net(input), None), literal(width, value));
            }
            for &(axis, value) in end {
                let _ = write!(text, " (= wanted{axis} {})", literal(positions[axis].1.get(), value));
            }
            text += ")";
        }
        text += "))\n(assert (or ";
        text += violated;
        let _ = write!(text, "\n  (= {} #b0)", name(done, Some(clocks)));
        for (axis, (net, _)) in positions.iter().enumerate() {
            let _ = write!(text, " (not (= {} wanted{axis}))", name(*net, Some(clocks)));
        }
        text + "))\n(check-sat)\n"
    });
    let script = script.map_err(ModelError::from)?;
    Ok(Question { script, geometries, clocks })
}

/// Does a change of the processes that run, of which it has the list, so that a signal comes before it or after it.
pub type Attend<'a> = &'a dyn Fn(&mut dyn FnMut(&mut Vec<u32>));

/// Asks a solver: its command, whose words stand apart by blanks, gets the script on its input. After the `limit` it is
/// killed with all that it has started, and gives no answer. `attend` does what starts and what ends it, each of which
/// changes the list of the processes that run, so that what ends this process can end that one, too.
///
/// # Errors
/// It cannot be run, or says neither `sat` nor `unsat`, or nothing in time.
pub fn ask(command: &str, script: &str, limit: Duration, attend: Attend<'_>) -> Result<Answer, SolverError> {
    let failed = |error| SolverError::Start { command: command.to_owned(), error };
    let mut words = command.split_whitespace();
    let program = words.next().unwrap_or_default();
    let mut asked = Command::new(program);
    asked.args(words).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
    // A group of its own, which ends as a whole.
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(&mut asked, 0);
    let mut spawned = None;
    attend(&mut |running| {
        let child = spawned.insert(asked.spawn());
        running.extend(child.as_ref().ok().map(Child::id));
    });
    let Some(mut child) = spawned.transpose().map_err(failed)? else {
        return Err(failed(std::io::ErrorKind::Interrupted.into()));
    };
    let (input, output) = (child.stdin.take(), child.stdout.take());
    // The two threads are not waited for: children of the solver may hold its input and output open for ever.
    let owned = script.to_owned();
    // One that talks before it has read all would wait for a reader, as this would for it; one that answers before closes
    // its input.
    std::thread::spawn(move || input.map(|mut input| input.write_all(owned.as_bytes())));
    let (sender, receiver) = std::sync::mpsc::channel();
    std::thread::spawn(move || {
        // Nobody listens any more after the limit.
        let _ = sender.send(output.map_or_else(|| Ok(String::new()), answer_of));
    });
    // The first line that is not a comment is the answer.
    let said = receiver.recv_timeout(limit);
    let ended = end(&mut child, attend);
    let Ok(said) = said else {
        return Err(SolverError::Late { command: command.to_owned(), seconds: limit.as_secs() });
    };
    let said = said.and_then(|said| ended.map(|_| said)).map_err(failed)?;
    match said.lines().next().map(str::trim) {
        Some("sat" | "s SATISFIABLE" | "SATISFIABLE") => Ok(Answer::Sat),
        Some("unsat" | "s UNSATISFIABLE" | "UNSATISFIABLE") => Ok(Answer::Unsat),
        first => Err(SolverError::Answer { command: command.to_owned(), said: first.unwrap_or_default().to_owned() }),
    }
}

/// The first line that a solver says and that is not a comment, as SAT solvers begin with.
fn answer_of(output: impl Read) -> std::io::Result<String> {
    for line in BufReader::new(output).take(MOST_SAID).lines() {
        let line = line?;
        if line != "c" && !line.starts_with("c ") {
            return Ok(line);
        }
    }
    Ok(String::new())
}

/// Ends a solver and what it has started.
fn end(child: &mut Child, attend: Attend<'_>) -> std::io::Result<std::process::ExitStatus> {
    #[cfg(unix)]
    if let Ok(number) = i32::try_from(child.id())
        && let Some(group) = rustix::process::Pid::from_raw(number)
    {
        // One that has gone needs no end.
        let _ = rustix::process::kill_process_group(group, rustix::process::Signal::KILL);
    }
    let killed = child.kill();
    // Once it was waited for, its number may be another's.
    attend(&mut |running| running.retain(|number| *number != child.id()));
    killed.and_then(|()| child.wait())
}
