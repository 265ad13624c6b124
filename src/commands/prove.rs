//! `stepwave prove`: proofs over all geometries and widths, and counterexamples.

mod check;
mod counted;
mod every_width;
mod replay;
mod verdict;

use std::io::Write as _;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use stepwave::kernel::prove::Certificate;
use stepwave::models::{Choices, Claims, Model, find};
use stepwave::study::proof::{
    Answer, CertificateFile, Counterexample, Fault, Narrower, ProofError, ask, question, search,
};

use crate::cli::{ProveArgs, ProveCommand};
use crate::failure::Failure;
use crate::output::{self, Outputs, Sink};

/// Attempts a proof, or checks one.
pub(crate) fn run(args: &ProveArgs) -> Result<(), Failure> {
    match &args.check {
        Some(ProveCommand::Check { file }) => check::check(file),
        None => attempt(args),
    }
}

/// Prints a text, unless standard output is where a file goes.
fn tell(args: &ProveArgs, text: &str) -> Result<(), Failure> {
    let is_stdout = |path: &Option<PathBuf>| path.as_deref() == Some(Path::new("-"));
    if is_stdout(&args.certificate) || is_stdout(&args.vcd) { Ok(()) } else { output::print(text) }
}

/// Bits of coordinates among which counterexamples are looked for.
const SEARCHED: RangeInclusive<u32> = 1..=6;
/// Bits of coordinates that a solver is asked about unless the user says otherwise.
const ASKED: u32 = 2;

/// What is to be proved of which hardware.
struct Job<'a> {
    args: &'a ProveArgs,
    model: &'static Model,
    claims: Claims,
    choices: Choices,
    narrower: Narrower,
}

impl Job<'_> {
    /// The first geometry that refutes the claims on hardware of these choices, of coordinates of so many bits.
    fn counterexample(&self, choices: &Choices, ks: RangeInclusive<u32>) -> Option<Counterexample> {
        // A word that does not fit refutes a narrower register; else it tells that a choice, such as a preset, needs more
        // bits.
        let refutes = |fault| fault != Fault::Refused || !self.narrower.is_empty();
        search(self.model, &self.claims, choices, &self.narrower, ks, refutes)
    }

    /// Opens the file of the certificate, if one is wanted, before anything is attempted.
    fn certificate(&self) -> Result<CertificateOutput<'_>, Failure> {
        let mut outputs = Outputs::default();
        let sink = self.args.certificate.as_deref().map(|path| outputs.open(path)).transpose()?;
        Ok(CertificateOutput { job: self, outputs, sink })
    }

    /// What a solver says of every geometry of some bits.
    fn asked(&self, command: &str) -> Result<Answer, Failure> {
        let k = self.args.bits.unwrap_or(ASKED);
        let question = question(self.model, &self.claims, &self.choices, &self.narrower, k)
            .map_err(|error| self.args.hardware.told_of_study(error))?;
        let answer = ask(command, &question.script)?;
        let (word, what) = match answer {
            Answer::Sat => ("sat", "a register overflows or an end point is missed"),
            Answer::Unsat => ("unsat", "no register overflows, and every end point is reached"),
        };
        let (geometries, clocks) = (question.geometries, question.clocks);
        let text =
            format!("{command} says {word} of {geometries} geometries of {k} bits within {clocks} clocks: {what}\n");
        tell(self.args, &text)?;
        Ok(answer)
    }
}

/// Where the certificate goes; dropped, it leaves no file.
struct CertificateOutput<'a> {
    job: &'a Job<'a>,
    outputs: Outputs,
    sink: Option<Sink>,
}

impl CertificateOutput<'_> {
    /// Writes what was proved, with these options of the hardware.
    fn write(
        self,
        options: Vec<String>,
        kinds: Vec<(String, Certificate)>,
        counted: Vec<String>,
    ) -> Result<(), Failure> {
        if let Some(mut sink) = self.sink {
            let narrower = self.job.narrower.clone().into_iter().collect();
            let file = CertificateFile { model: self.job.model.name.to_owned(), options, narrower, kinds, counted };
            write!(sink, "{file}")?;
            sink.flush()?;
        }
        self.outputs.commit()
    }
}

fn attempt(args: &ProveArgs) -> Result<(), Failure> {
    let model = find(args.model.as_deref().unwrap_or_default())?;
    let claims = model.claims.ok_or(ProofError::NoClaims { model: model.name })?;
    // Whichever is written in the end, both are tried before anything is attempted.
    let mut both = Outputs::default();
    args.certificate.iter().chain(&args.vcd).try_for_each(|path| both.claim(path).map(drop))?;
    let narrower = args.narrower.iter().flat_map(|list| list.0.iter().cloned()).collect();
    let job = Job { args, model, claims, choices: args.hardware.choices(), narrower };
    let counted = !claims.counted.is_empty();
    if args.bits.is_some() && !counted && args.solver.is_none() {
        let model = model.name;
        return Err(Failure::Trouble(format!("{model} is proved for all k at once: leave --bits out")));
    }
    let second = args.solver.as_deref().map(|command| job.asked(command)).transpose()?;
    let own = if counted { counted::attempt(&job) } else { every_width::attempt(&job) };
    match (&own, second) {
        (Ok(()), Some(Answer::Sat)) => Err(Failure::Check(vec![format!(
            "{}: what is proved here the solver says is wrong: one of both errs, please report this",
            model.name
        )])),
        _ => own,
    }
}
