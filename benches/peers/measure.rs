//! One run of a program: what it took. A program is started by this one anew (`--measure`), which waits for it and
//! reports the processor time and the peak memory of it and of all that it started.

use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use rustix::thread::{CpuSet, sched_getaffinity, sched_setaffinity};
use wait4::Wait4;

use crate::Fallible;

/// A program with its words, run in a folder.
#[derive(Clone, Debug)]
pub(crate) struct Job {
    /// Of the column.
    pub(crate) name: &'static str,
    pub(crate) words: Vec<String>,
    pub(crate) dir: PathBuf,
    /// Cores that it may use; `None`: all.
    pub(crate) cores: Option<usize>,
    /// What it writes; its size is reported, then it is deleted.
    pub(crate) wave: Option<PathBuf>,
    /// How its standard output says what came of it.
    pub(crate) says: fn(&str) -> Fallible<String>,
    /// Rounds that it takes part in.
    pub(crate) rounds: usize,
}

impl Job {
    pub(crate) fn new(name: &'static str, dir: &Path, words: &[&str]) -> Job {
        let words = words.iter().map(|&word| word.to_owned()).collect();
        let dir = dir.to_owned();
        Job { name, words, dir, cores: Some(1), wave: None, says: |text| Ok(text.to_owned()), rounds: usize::MAX }
    }

    pub(crate) fn wave(mut self, name: &str) -> Job {
        self.wave = Some(self.dir.join(name));
        self
    }

    pub(crate) fn says(mut self, says: fn(&str) -> Fallible<String>) -> Job {
        self.says = says;
        self
    }

    pub(crate) fn cores(mut self, cores: Option<usize>) -> Job {
        self.cores = cores;
        self
    }

    pub(crate) fn rounds(mut self, rounds: usize) -> Job {
        self.rounds = rounds;
        self
    }
}

/// What a run took and made.
#[derive(Clone, Debug, Default)]
pub(crate) struct Measurement {
    /// Seconds on the clock, and of processor time.
    pub(crate) wall: f64,
    pub(crate) computed: f64,
    pub(crate) peak_mb: f64,
    pub(crate) wave_bytes: f64,
    said: String,
}

impl Measurement {
    /// The clocks that the program said it has run.
    pub(crate) fn clocks(&self) -> f64 {
        self.said.split(' ').next().and_then(|word| word.parse().ok()).unwrap_or(f64::NAN)
    }

    /// The same of all lines: of many blocks.
    pub(crate) fn all_clocks(&self) -> f64 {
        let first = |line: &str| line.split(' ').next().and_then(|word| word.parse::<f64>().ok());
        self.said.lines().filter_map(first).sum()
    }
}

/// Runs all jobs round by round, so that what else the machine does meets all alike; all must come to the same. The
/// runs of each job.
pub(crate) fn race(rounds: usize, jobs: &[Job]) -> Fallible<Vec<Vec<Measurement>>> {
    let mut runs: Vec<Vec<Measurement>> = vec![Vec::new(); jobs.len()];
    for round in 0..rounds {
        for (job, runs) in jobs.iter().zip(&mut runs).filter(|(job, _)| round < job.rounds) {
            if let (Some(path), Some(last)) = (&job.wave, runs.last()) {
                give_pages(path, last.wave_bytes)?;
            }
            let run = measure(job, round)?;
            eprintln!("    {:<24} {:>9.3} s, computed {:>9.3} s", job.name, run.wall, run.computed);
            runs.push(run);
        }
        let said: Vec<&str> = runs.iter().filter_map(|runs| Some(runs.last()?.said.as_str())).collect();
        if let Some(other) = said.iter().position(|words| *words != said[0]) {
            let (first, other) = ((jobs[0].name, said[0]), (jobs[other].name, said[other]));
            return Err(format!("not the same: {first:?}, {other:?}").into());
        }
    }
    Ok(runs)
}

/// Writes a file as long as the one to come, and removes it. A hypervisor takes back pages that rest for some seconds, and who
/// writes the next file pays for them anew: a microsecond for each, which is as much as writing it. So no run pays.
#[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn give_pages(path: &Path, bytes: f64) -> Fallible<()> {
    let mut file = File::create(path)?;
    let part = vec![0_u8; 1 << 20];
    for _ in 0..(bytes / part.len() as f64).ceil() as usize {
        file.write_all(&part)?;
    }
    Ok(fs::remove_file(path)?)
}

#[allow(clippy::cast_precision_loss)]
fn measure(job: &Job, round: usize) -> Fallible<Measurement> {
    let mut command = Command::new(std::env::current_exe()?);
    command.arg("--measure").arg(job.cores.unwrap_or(0).to_string()).arg(round.to_string());
    let output = command.args(&job.words).current_dir(&job.dir).stderr(Stdio::inherit()).output()?;
    let text = String::from_utf8(output.stdout)?;
    let (said, report) =
        text.trim_end().rsplit_once("\n--\n").ok_or_else(|| format!("{:?} failed: {text}", job.words))?;
    let report: Vec<f64> = report.split(' ').map(str::parse).collect::<Result<_, _>>()?;
    let [failed, wall, computed, peak_mb] = report[..] else { return Err(format!("no report: {text}").into()) };
    if failed != 0.0 {
        return Err(format!("{:?} failed: {said}", job.words).into());
    }
    let mut wave_bytes = 0.0;
    if let Some(path) = &job.wave {
        wave_bytes = path.metadata()?.len() as f64;
        fs::remove_file(path)?;
    }
    Ok(Measurement { wall, computed, peak_mb, wave_bytes, said: (job.says)(said.trim())? })
}

/// The other side: cores, round, program and words. Prints what the program prints, and in the last line, after `--`,
/// what it took.
#[allow(clippy::cast_precision_loss)]
pub(crate) fn child(words: &[String]) -> Fallible<()> {
    let [cores, round, program, words @ ..] = words else { return Err("no program to measure".into()) };
    allow(cores.parse()?, round.parse()?)?;
    let start = Instant::now();
    let mut program = Command::new(program).args(words).stdout(Stdio::piped()).spawn()?;
    let mut said = Vec::new();
    program.stdout.take().ok_or("no output")?.read_to_end(&mut said)?;
    let ended = program.wait4()?;
    let wall = start.elapsed().as_secs_f64();
    let computed = (ended.rusage.utime + ended.rusage.stime).as_secs_f64();
    let mut out = io::stdout();
    out.write_all(&said)?;
    let failed = u8::from(!ended.status.success());
    Ok(writeln!(out, "\n--\n{failed} {wall} {computed} {}", ended.rusage.maxrss as f64 / f64::from(1 << 20))?)
}

/// Leaves this many cores to this process; which ones changes from round to round.
fn allow(cores: usize, round: usize) -> Fallible<()> {
    let all = sched_getaffinity(None)?;
    let mine: Vec<usize> = (0..CpuSet::MAX_CPU).filter(|&core| all.is_set(core)).collect();
    if cores == 0 {
        return Ok(());
    }
    let mut set = CpuSet::new();
    for index in 0..cores.min(mine.len()) {
        set.set(mine[(round + index) % mine.len()]);
    }
    Ok(sched_setaffinity(None, &set)?)
}
