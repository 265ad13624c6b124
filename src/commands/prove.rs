//! `stepwave prove`: proofs over all geometries and widths, and counterexamples.

mod boxed;
mod netlist;
mod replay;
mod text;

use std::fs::File;
use std::io::{Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use crate::study::proof::{
    Answer, Attempt, CheckError, Claim, Effort, Evidence, INDUCTION_KS, InductionSearch, MOST_BYTES, ProofError,
    Proposition, SEARCHED, SolverError, Verdict, ask, check_with, choices_at, names, proved, question, unproved,
};

use super::progress::Progress;
use super::view::View;
use crate::Error;
use crate::cli::{ProveArgs, ProveCommand};
use crate::output::{self, Outputs, Sink, temporary};
use crate::own::is_netlist;
use crate::study::Extent;

/// Attempts a proof, or checks one.
pub(crate) fn run(args: &ProveArgs) -> Result<(), Error> {
    // Refused before anything is attempted.
    View::new(&args.by_ending, &args.waves(), None)?;
    if args.vcd.is_some() {
        args.waves().check_viewer()?;
    }
    let done = match &args.check {
        Some(ProveCommand::Check { file }) => check(file),
        None => match args.model.as_deref() {
            Some(path) if is_netlist(path) => {
                // What has a box has a bench file, that says what it interpolates.
                let extent = match args.extent.is_some() || args.travel.is_some() {
                    true => args.extent_for(args.bench.model(path)?)?,
                    false => None,
                };
                match extent {
                    Some(extent) => boxed::prove(args, path, &extent),
                    None => netlist::prove(args, Path::new(path)),
                }
            }
            _ => match unclaimed(args)? {
                Some((name, extent)) => boxed::prove(args, name, &extent),
                None => attempt(args),
            },
        },
    };
    done?;
    // A wave of an earlier proof may have this name.
    args.vcd
        .as_ref()
        .map_or(Ok(()), |file| tell(args, &format!("no counterexample: {} is not written\n", file.display())))
}

/// A model whose author claims nothing, of given widths, with its box: every geometry is run.
fn unclaimed(args: &ProveArgs) -> Result<Option<(&'static str, Extent)>, Error> {
    let asked = proposition(args)?;
    let extent = if asked.model.claims.is_none() { asked.bounds() } else { None };
    Ok(extent.map(|extent| (asked.model.name, extent)))
}

/// Opens the wave that was written, or says on a terminal how to.
fn open_wave(args: &ProveArgs) -> Result<(), Error> {
    View::new(&args.by_ending, &args.waves(), None)?.show()
}

/// Prints a text, unless standard output is where a file goes, or nothing is to be printed.
fn tell(args: &ProveArgs, text: &str) -> Result<(), Error> {
    let is_stdout = |path: &Option<PathBuf>| path.as_deref() == Some(Path::new("-"));
    if args.by_ending.outputs.quiet || is_stdout(&args.certificate) || is_stdout(&args.vcd) {
        Ok(())
    } else {
        output::print(text)
    }
}

/// Bits of coordinates that a solver is asked about unless the user says otherwise.
const ASKED: u32 = 2;

/// What the command line asks to prove.
fn proposition(args: &ProveArgs) -> Result<Proposition, Error> {
    let model = args.bench.model(args.model.as_deref().unwrap_or_default())?;
    let mut asked = Proposition::of(model)
        .options(args.hardware.choices())
        .extent(args.extent_for(model)?)
        .any_preset(args.any_preset);
    for (name, bits) in args.narrower.iter().flat_map(|list| list.0.iter()) {
        if let Some(before) = asked.narrower.insert(name.clone(), *bits) {
            return Err(Error::Invalid(format!(
                "--narrower gives '{name}' two values, {before} and {bits}: leave one of them out"
            )));
        }
    }
    Ok(asked)
}

/// Refuses options that are about one width at a time, or about every one, where they have no meaning.
fn check_options(args: &ProveArgs, proposition: &Proposition) -> Result<(), Error> {
    let counted = !proposition.claims()?.counted.is_empty();
    let ProveArgs { narrower, solver, bits, any_preset, .. } = args;
    let buffered = proposition.model.is_buffered();
    let given = [
        (!narrower.is_empty(), "--narrower"),
        (solver.is_some(), "--solver"),
        (bits.is_some(), "--bits"),
        (*any_preset, "--any-preset"),
    ];
    match given.into_iter().find(|(given, _)| *given) {
        Some((_, option)) if proposition.is_fixed() => Err(ProofError::ForEveryK { option }.into()),
        _ if bits.is_some() && !counted && solver.is_none() && !proposition.is_fixed() && !buffered => {
            let model = proposition.model.name;
            Err(Error::Invalid(format!("{model} is proved for all k at once: leave --bits out")))
        }
        _ => Ok(()),
    }
}

/// What a solver says of every geometry of some bits; `None` where it says nothing in time.
fn asked(args: &ProveArgs, proposition: &Proposition, command: &str) -> Result<Option<Answer>, Error> {
    let Proposition { model, options, narrower, .. } = proposition;
    let k = args.bits.unwrap_or(ASKED);
    let question = question(model, &proposition.claims_for_every_k()?, options, narrower, k)
        .map_err(|error| args.hardware.explain_study(error))?;
    let answer = match ask(command, &question.script, Duration::from_secs(args.solver_seconds), &temporary::attend) {
        Err(late @ SolverError::Late { .. }) => {
            tell(args, &format!("{late}\n"))?;
            return Ok(None);
        }
        answer => answer?,
    };
    let (word, what) = match answer {
        Answer::Sat => ("sat", "a register overflows or an end point is missed"),
        Answer::Unsat => ("unsat", "no register overflows, and every end point is reached"),
    };
    let (geometries, clocks) = (question.geometries, question.clocks);
    let text = format!("{command} says {word} of {geometries} geometries of {k} bits within {clocks} clocks: {what}\n");
    tell(args, &text)?;
    Ok(Some(answer))
}

/// Shows how far each piece of work is, one after the other.
#[derive(Default)]
struct Bars(Mutex<Option<(&'static str, Progress)>>);

impl Bars {
    fn show(&self, what: &'static str, done: usize, all: usize) {
        let mut shown = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let same = shown.take().filter(|(before, _)| done > 0 && *before == what);
        let (_, progress) = shown.insert(same.unwrap_or_else(|| (what, Progress::of(all as u64, what))));
        progress.set(done as u64);
    }
}

/// Where the certificate goes; dropped, it leaves no file.
struct CertificateOutput {
    outputs: Outputs,
    sink: Option<Sink>,
}

impl CertificateOutput {
    /// Opens the file, if one is wanted, before anything is attempted.
    fn open(args: &ProveArgs) -> Result<CertificateOutput, Error> {
        let mut outputs = Outputs::default();
        let sink = args.certificate.as_deref().map(|path| outputs.open(path)).transpose()?;
        Ok(CertificateOutput { outputs, sink })
    }

    /// Writes the certificate; where there is none, no file.
    fn write(self, verdict: &Verdict) -> Result<(), Error> {
        let Some(certificate) = verdict.certificate() else { return Ok(()) };
        if let Some(mut sink) = self.sink {
            write!(sink, "{certificate}")?;
            sink.flush()?;
        }
        self.outputs.commit()
    }
}

fn attempt(args: &ProveArgs) -> Result<(), Error> {
    if let Some(option) = args.netlist.given() {
        let model = args.model.as_deref().unwrap_or_default();
        return Err(Error::Invalid(format!(
            "{option} is of a netlist, such as F.net, and {model} is a model: leave it out"
        )));
    }
    // Whichever is written in the end, both are tried before anything is attempted.
    let mut both = Outputs::default();
    args.certificate.iter().chain(&args.vcd).try_for_each(|path| both.claim(path).map(drop))?;
    let proposition = proposition(args)?;
    check_options(args, &proposition)?;
    let second = args.solver.as_deref().map(|command| asked(args, &proposition, command)).transpose()?.flatten();
    match second {
        // Of a machine with a buffer the solver's is the only answer for every geometry of some bits.
        Some(Answer::Unsat) if proposition.model.is_buffered() => return Ok(()),
        Some(Answer::Sat) if proposition.model.is_buffered() => {
            return Err(Error::Check(vec![format!("{} is refuted by the solver", proposition.model.name)]));
        }
        _ => {}
    }
    let certificate = CertificateOutput::open(args)?;
    let bars = Bars::default();
    let progress = |what, done, all| bars.show(what, done, all);
    let effort = Effort { bits: args.bits, certificate: args.certificate.is_some(), progress: &progress };
    let verdict = proposition.prove(&effort).map_err(|error| args.hardware.explain_study(error))?;
    drop(bars);
    match (show(args, &verdict, certificate), second) {
        (Ok(()), Some(Answer::Sat)) => Err(Error::Check(vec![format!(
            "{}: what is proved here the solver says is wrong: one of both errs, please report this",
            proposition.model.name
        )])),
        (own, _) => own,
    }
}

/// Reports a verdict, and writes its certificate.
fn show(args: &ProveArgs, verdict: &Verdict, certificate: CertificateOutput) -> Result<(), Error> {
    let Verdict { proposition, scope, evidence, .. } = verdict;
    let failure = match evidence {
        Evidence::Refuted(example) => return replay::refuted(args, proposition, example),
        Evidence::Open(why) => why.clone(),
        Evidence::Unbounded => {
            let hardware = proposition.hardware();
            tell(args, &format!("{hardware}\nUNKNOWN: where these widths begin to be too narrow was not found\n"))?;
            format!("not proved: {}; give a box of geometries, such as --travel 100", names(&Claim::ALL))
        }
        Evidence::Simulated { tried, why } => {
            let whole = tried.is_whole();
            let no_proof = whole && args.certificate.is_some();
            let none = if no_proof { "no certificate: simulation shows it, no proof\n" } else { "" };
            tell(args, &format!("{}{none}", text::of_simulated(scope, tried, why)))?;
            if whole {
                return Ok(());
            }
            format!("not proved {}: {}; no counterexample was found", scope.widths, names(&Claim::ALL))
        }
        Evidence::Blocks(blocks) => {
            certificate.write(verdict)?;
            return tell(args, &text::of_blocks(scope, blocks));
        }
        Evidence::Steps { attempts, below, induction } => {
            let mut text = text::of_steps(scope, attempts, args.details) + &text::of_least_widths(below);
            let failure = induction.as_ref().map(|looked| undecided(args, proposition, attempts, looked, &mut text));
            let failure = failure.transpose()?;
            if failure.is_some() && args.certificate.is_some() {
                text += &match proved(attempts) {
                    none if none.is_empty() => "no certificate: nothing is proved\n".to_owned(),
                    shown => format!("the certificate proves a part: {}\n", names(&shown)),
                };
            }
            certificate.write(verdict)?;
            tell(args, &text)?;
            let Some(failure) = failure else { return Ok(()) };
            failure
        }
    };
    Err(Error::Check(vec![failure]))
}

/// What is open after every attempt, and what keeps a proof from being one, after the text of what was proved.
fn undecided(
    args: &ProveArgs,
    proposition: &Proposition,
    attempts: &[Attempt],
    looked: &InductionSearch,
    text: &mut String,
) -> Result<String, Error> {
    let open = names(&unproved(attempts));
    let most = SEARCHED.end();
    let mut failure =
        format!("not proved: {open}; no counterexample among the geometries of up to {most} bits that were tried");
    if let Some(step) = &looked.found {
        let Proposition { model, options, narrower, .. } = proposition;
        let own = choices_at(model, &proposition.claims()?, options, narrower, step.k)?;
        *text += &replay::not_inductive(args, model, step, &own)?;
        failure += "; a step from a state that may be unreachable shows why";
    } else {
        let ([first, last], tried) = (INDUCTION_KS, looked.tried);
        *text += &format!(
            "UNKNOWN: no step from {tried} states at k = {first} and {last} that the invariants allow shows why\n"
        );
    }
    Ok(failure)
}

/// Checks a file of certificates: nothing is looked for.
fn check(path: &Path) -> Result<(), Error> {
    let name = path.display();
    let bars = Bars::default();
    let progress = |what, done, all| bars.show(what, done, all);
    let verdict = check_with(&read(path)?, &Effort { progress: &progress, ..Effort::default() });
    drop(bars);
    let verdict = verdict.map_err(|error| match error {
        CheckError::File(_) => Error::Invalid(format!("{name} is {error}")),
        CheckError::Proof(error) => error.into(),
        CheckError::Blocks | CheckError::NoFamily => Error::Check(vec![format!("{name} {error}")]),
    })?;
    let Evidence::Steps { attempts, .. } = &verdict.evidence else {
        return match verdict.evidence {
            Evidence::Blocks(blocks) => output::print(&text::of_blocks(&verdict.scope, &blocks)),
            Evidence::Open(why) => Err(Error::Check(vec![why])),
            _ => Err(Error::Check(vec![format!("{name} proves nothing")])),
        };
    };
    output::print(&text::of_steps(&verdict.scope, attempts, false))?;
    let (open, shown) = (names(&unproved(attempts)), names(&proved(attempts)));
    Err(Error::Check(vec![match (&*open, &*shown) {
        ("", _) => return Ok(()),
        (open, "") => format!("{name} does not prove: {open}"),
        (open, shown) => format!("{name} proves a part ({shown}), and does not prove: {open}"),
    }]))
}

/// The text of a file that is not too large for a certificate.
fn read(path: &Path) -> Result<String, Error> {
    let name = path.display();
    let mut text = String::new();
    let read = File::open(path).and_then(|file| file.take(MOST_BYTES + 1).read_to_string(&mut text));
    read.map_err(|error| Error::Invalid(format!("cannot read {name}: {error}")))?;
    if text.len() as u64 > MOST_BYTES {
        let most = MOST_BYTES >> 20;
        return Err(Error::Invalid(format!(
            "{name} is no certificate: it holds more than {most} MiB, the most of one"
        )));
    }
    Ok(text)
}
