//! `stepwave golden`.

use super::progress::Progress;
use crate::Error;
use crate::cli::GoldenCommand;
use crate::engine::EngineKind;
use crate::golden::{all_of, cases};
use crate::output;

/// Checks or records every case, or those that are named.
pub(crate) fn run(command: &GoldenCommand) -> Result<(), Error> {
    let (args, record) = match command {
        GoldenCommand::Check(args) => (args, false),
        GoldenCommand::Record(args) => (args, true),
    };
    if args.viewer.is_some() {
        return Err(Error::Invalid(
            "golden waves have the files of GTKWave, which are compared too: leave --viewer out; `stepwave run … --vcd F \
             --viewer surfer` writes those of Surfer"
                .to_owned(),
        ));
    }
    let names: Vec<&String> = args.cases.iter().chain(&args.case).collect();
    let mut progress = None;
    let all = cases::read(&args.dir)?;
    let chosen = cases::chosen(&all, &names, &args.dir)?;
    let mut report = all_of(&args.dir, &all, chosen, record, &mut |done, all| {
        progress.get_or_insert_with(|| Progress::of(all as u64, "cases")).add(u64::from(done > 0));
    })?;
    if let Some(progress) = progress {
        progress.finish();
    }
    if report.differences.is_empty() {
        let verb = if record { "recorded" } else { "same, bit by bit" };
        report.text += &format!("{} cases {verb}, from {} engines\n", report.cases, EngineKind::ALL.len());
    }
    output::print(&report.text)?;
    if report.differences.is_empty() { Ok(()) } else { Err(Error::Check(report.differences)) }
}
