//! `stepwave prove`: proofs over all geometries and widths, and counterexamples.

mod at_widths;
mod check;
mod counted;
mod every_width;
mod replay;
mod simulated;
mod verdict;

use std::io::Write as _;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::models::options::WIDTH;
use crate::models::{Claims, Model, Options, find};
use crate::prove::Certificate;
use crate::study::Extent;
use crate::study::proof::{
    Answer, CertificateFile, Fault, Fixed, Narrower, ProofError, SolverError, Subject, Survey, ask, question, search,
};

use self::verdict::hardware_in_words;
use crate::Error;
use crate::cli::{ProveArgs, ProveCommand};
use crate::output::{self, Outputs, Sink, temporary};

/// Attempts a proof, or checks one.
pub(crate) fn run(args: &ProveArgs) -> Result<(), Error> {
    match &args.check {
        Some(ProveCommand::Check { file }) => check::check(file),
        None => attempt(args),
    }
}

/// Prints a text, unless standard output is where a file goes.
fn tell(args: &ProveArgs, text: &str) -> Result<(), Error> {
    let is_stdout = |path: &Option<PathBuf>| path.as_deref() == Some(Path::new("-"));
    if is_stdout(&args.certificate) || is_stdout(&args.vcd) { Ok(()) } else { output::print(text) }
}

/// By how many bits registers are narrower.
fn narrower(args: &ProveArgs) -> Result<Narrower, Error> {
    let mut narrower = Narrower::new();
    for (name, bits) in args.narrower.iter().flat_map(|list| list.0.iter().cloned()) {
        if let Some(before) = narrower.insert(name.clone(), bits) {
            return Err(Error::Invalid(format!(
                "--narrower gives '{name}' two values, {before} and {bits}: leave one of them out"
            )));
        }
    }
    Ok(narrower)
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
    choices: Options,
    narrower: Narrower,
}

impl<'a> Job<'a> {
    fn new(args: &'a ProveArgs, narrower: Narrower) -> Result<Job<'a>, Error> {
        let model = find(args.model.as_deref().unwrap_or_default())?;
        let claims = model.claims.ok_or(ProofError::NoClaims { model: model.name })?;
        Ok(Job { args, model, claims, choices: args.hardware.choices(), narrower })
    }

    /// The box that is given, or what coordinates of the width that is given for all registers hold.
    fn extent(&self) -> Option<Extent> {
        let of_width = || self.choices.of_all(&WIDTH).map(|width| Extent::Bits(width.get()));
        self.args.extent.clone().or_else(|| self.args.travel.clone().map(|travel| travel.0)).or_else(of_width)
    }

    /// It is about one hardware, and not about one for every k.
    fn is_fixed(&self) -> bool {
        self.extent().is_some() || !self.choices.of_single(&WIDTH).is_empty()
    }

    fn fixed(&self, extent: Extent) -> Result<Fixed, Error> {
        let told = |error| self.args.hardware.explain_study(error);
        Fixed::new(self.model, &self.choices, extent).map_err(told)
    }

    /// Refuses options that are about one width at a time, or about every one, where the widths are given.
    fn check_fixed(&self) -> Result<(), Error> {
        let ProveArgs { narrower, solver, bits, any_preset, .. } = self.args;
        let given = [
            (!narrower.is_empty(), "--narrower"),
            (solver.is_some(), "--solver"),
            (bits.is_some(), "--bits"),
            (*any_preset, "--any-preset"),
        ];
        match given.into_iter().find(|(given, _)| *given) {
            Some((_, option)) => Err(Error::Invalid(format!(
                "{option} is for hardware of every k, but --width, --box or --travel choose one: leave one of them out"
            ))),
            None => Ok(()),
        }
    }

    /// The hardware in words.
    fn hardware(&self) -> String {
        hardware_in_words(self.model, &self.options(), &self.narrower)
    }

    /// The hardware of every width.
    fn subject(&self) -> Result<Subject, Error> {
        let told = |error| self.args.hardware.explain_study(error);
        let subject = Subject::new(self.model, &self.choices, &self.narrower).map_err(told)?;
        Ok(if self.args.any_preset { subject.with_any_preset() } else { subject })
    }

    /// Simulates until a geometry refutes the claims on hardware of these choices, of coordinates of so many bits.
    fn search(&self, choices: &Options, ks: RangeInclusive<u32>) -> Survey {
        // A word that does not fit refutes a narrower register; else it says that a choice, such as a preset, needs more
        // bits.
        let refutes = |fault| fault != Fault::Refused || !self.narrower.is_empty();
        search(self.model, &self.claims, choices, &self.narrower, ks, refutes)
    }

    /// The options of the hardware, for a certificate.
    fn options(&self) -> Vec<String> {
        let any = self.args.any_preset.then(|| "--any-preset".to_owned());
        let extent = self.extent().filter(|_| self.args.extent.is_some() || self.args.travel.is_some());
        let extent = extent.into_iter().flat_map(|extent| {
            let extent = match extent {
                Extent::Bits(bits) => bits.to_string(),
                Extent::Grid(grid) => grid.to_string(),
            };
            ["--box".to_owned(), extent]
        });
        self.choices.words().into_iter().chain(any).chain(extent).collect()
    }

    /// Opens the file of the certificate, if one is wanted, before anything is attempted.
    fn certificate(&self) -> Result<CertificateOutput<'_>, Error> {
        let mut outputs = Outputs::default();
        let sink = self.args.certificate.as_deref().map(|path| outputs.open(path)).transpose()?;
        Ok(CertificateOutput { job: self, outputs, sink })
    }

    /// What a solver says of every geometry of some bits; `None` where it says nothing in time.
    fn asked(&self, command: &str) -> Result<Option<Answer>, Error> {
        let k = self.args.bits.unwrap_or(ASKED);
        let question = question(self.model, &self.claims, &self.choices, &self.narrower, k)
            .map_err(|error| self.args.hardware.explain_study(error))?;
        let answer =
            match ask(command, &question.script, Duration::from_secs(self.args.solver_seconds), &temporary::attend) {
                Err(late @ SolverError::Late { .. }) => {
                    tell(self.args, &format!("{late}\n"))?;
                    return Ok(None);
                }
                answer => answer?,
            };
        let (word, what) = match answer {
            Answer::Sat => ("sat", "a register overflows or an end point is missed"),
            Answer::Unsat => ("unsat", "no register overflows, and every end point is reached"),
        };
        let (geometries, clocks) = (question.geometries, question.clocks);
        let text =
            format!("{command} says {word} of {geometries} geometries of {k} bits within {clocks} clocks: {what}\n");
        tell(self.args, &text)?;
        Ok(Some(answer))
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
    fn write(self, options: Vec<String>, kinds: Vec<(String, Certificate)>, counted: Vec<String>) -> Result<(), Error> {
        if let Some(mut sink) = self.sink {
            let narrower = self.job.narrower.clone().into_iter().collect();
            let file = CertificateFile { model: self.job.model.name.to_owned(), options, narrower, kinds, counted };
            write!(sink, "{file}")?;
            sink.flush()?;
        }
        self.outputs.commit()
    }
}

fn attempt(args: &ProveArgs) -> Result<(), Error> {
    // Whichever is written in the end, both are tried before anything is attempted.
    let mut both = Outputs::default();
    args.certificate.iter().chain(&args.vcd).try_for_each(|path| both.claim(path).map(drop))?;
    let job = Job::new(args, narrower(args)?)?;
    let model = job.model;
    if job.is_fixed() {
        job.check_fixed()?;
        return at_widths::attempt(&job);
    }
    let counted = !job.claims.counted.is_empty();
    if args.bits.is_some() && !counted && args.solver.is_none() {
        let model = model.name;
        return Err(Error::Invalid(format!("{model} is proved for all k at once: leave --bits out")));
    }
    let second = args.solver.as_deref().map(|command| job.asked(command)).transpose()?.flatten();
    let own = if counted { counted::attempt(&job) } else { every_width::attempt(&job) };
    match (&own, second) {
        (Ok(()), Some(Answer::Sat)) => Err(Error::Check(vec![format!(
            "{}: what is proved here the solver says is wrong: one of both errs, please report this",
            model.name
        )])),
        _ => own,
    }
}
