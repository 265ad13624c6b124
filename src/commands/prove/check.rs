//! Certificates, checked alone.

use std::path::Path;

use clap::Parser;
use rayon::prelude::*;
use stepwave::models::{Choices, find};
use stepwave::study::proof::{Block, CertificateFile, ProofError, Subject, Way};

use super::counted::{followed, judge, unfollowed};
use super::verdict::{Attempt, told, unproved};
use crate::cli::{Cli, Command};
use crate::failure::Failure;
use crate::output;

/// Checks a file of certificates: nothing is looked for.
pub(super) fn check(path: &Path) -> Result<(), Failure> {
    let name = path.display();
    let text =
        std::fs::read_to_string(path).map_err(|error| Failure::Trouble(format!("cannot read {name}: {error}")))?;
    let file: CertificateFile =
        text.parse().map_err(|error| Failure::Trouble(format!("{name} is no certificate: {error}")))?;
    let model = find(&file.model)?;
    let words = ["stepwave", "prove", model.name].map(str::to_owned).into_iter().chain(file.options.iter().cloned());
    let parsed = Cli::try_parse_from(words).map_err(|error| Failure::usage(&error))?;
    let (choices, any_preset) = match &parsed.command {
        Command::Prove(args) => (args.hardware.choices(), args.any_preset),
        _ => (Choices::default(), false),
    };
    if model.claims.is_some_and(|claims| !claims.counted.is_empty()) {
        let mut ks: Vec<u32> = Vec::new();
        for block in &file.counted {
            let k = block.split(' ').next().and_then(|k| k.parse().ok()).filter(|k| (1..=20).contains(k));
            ks.push(k.ok_or_else(|| Failure::Trouble(format!("{name} is no certificate: counted {block}")))?);
        }
        ks.dedup();
        let blocks = followed(model, &choices, &file.narrower.iter().cloned().collect(), ks, Way::Recount)
            .map_err(|error| unfollowed(error, Failure::from))?;
        if blocks.iter().map(Block::to_string).ne(file.counted.iter().cloned()) {
            return Err(Failure::Check(vec![format!("{name} does not say what its blocks come to")]));
        }
        return output::print(&judge(model, &blocks, &format!("the blocks of {name}"))?);
    }
    let subject = Subject::new(model, &choices, &file.narrower.iter().cloned().collect())?;
    let subject = if any_preset { subject.with_any_preset() } else { subject };
    let attempts: Vec<Attempt> = subject
        .kinds()
        .into_par_iter()
        .map(|kind| {
            let own = file.kinds.iter().find(|(other, _)| *other == kind.name);
            let certificate = own.map(|(_, certificate)| certificate.clone()).unwrap_or_default();
            Ok((kind.clone(), subject.check(&kind, &certificate)?, certificate))
        })
        .collect::<Result<_, ProofError>>()?;
    output::print(&told(model, &subject, &attempts, false))?;
    let open = unproved(&attempts);
    let names: Vec<&str> = open.iter().map(|claim| claim.name()).collect();
    if open.is_empty() {
        Ok(())
    } else {
        Err(Failure::Check(vec![format!("{name} does not prove: {}", names.join(", "))]))
    }
}
