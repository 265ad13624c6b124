//! What came of a proposition, in words.

use std::fmt::Write as _;

use crate::study::proof::{Attempt, Block, Claim, Scope, Shown, Tried};

/// Every claim with its verdict.
pub(super) fn of_steps(scope: &Scope, attempts: &[Attempt], details: bool) -> String {
    let widths = &scope.widths;
    let (paths, shown) = attempts
        .iter()
        .fold((0, 0), |(paths, shown), (_, proof, _)| (paths + proof.paths, shown + proof.contradictions));
    // Writing to a string cannot fail.
    let mut text = format!("{}\n", scope.about);
    let ends = Claim::Ends.shown(attempts) == Shown::Proved;
    for claim in Claim::ALL {
        let name = claim.name();
        let _ = match claim.shown(attempts) {
            Shown::Proved if claim == Claim::Exact && !ends => {
                writeln!(text, "PROVED {widths}: {name} by every block that ends")
            }
            Shown::Proved => writeln!(text, "PROVED {widths}: {name}"),
            Shown::Unclaimed => writeln!(text, "not claimed: {name}"),
            Shown::UnlessOverflow => writeln!(text, "not proved: {name} (only as long as no register overflows)"),
            Shown::Open(open) => {
                let all = attempts.len();
                let many = if open == all { "for none".to_owned() } else { format!("not for {open}") };
                writeln!(text, "not proved: {name} ({many} of {all} kinds of geometry)")
            }
        };
        let why = attempts.iter().find_map(|(kind, proof, _)| Some((&kind.name, claim.open(proof)?)));
        if let (true, Some((kind, why))) = (details, why) {
            let _ = writeln!(text, "  {kind}: {why}");
        }
    }
    let _ = writeln!(
        text,
        "{} kinds of geometry, {paths} paths, {shown} contradictions, each checked in exact arithmetic",
        attempts.len()
    );
    if details {
        for (kind, proof, _) in attempts {
            let _ = writeln!(text, "\n{}", kind.name);
            for invariant in &proof.invariants {
                let _ = writeln!(text, "  {invariant}");
            }
        }
    }
    text
}

/// What blocks show that were followed.
pub(super) fn of_blocks(scope: &Scope, blocks: &[Block]) -> String {
    let clocks: u64 = blocks.iter().map(|block| block.clocks).sum();
    let proved = Claim::ALL.map(|claim| format!("PROVED {}: {}\n", scope.widths, claim.name())).concat();
    let number = blocks.len();
    format!("{}\n{proved}{number} blocks followed for {clocks} clocks with unknown coefficients\n", scope.about)
}

/// What geometries of a box show that were simulated.
pub(super) fn of_simulated(scope: &Scope, tried: &Tried, why: &str) -> String {
    let Scope { about, widths } = scope;
    let Tried { geometries, as_claimed, refused, given_up, .. } = tried;
    if tried.is_whole() {
        let proved =
            Claim::ALL.map(|claim| format!("PROVED {widths} (exhausted: {geometries} geometries): {}\n", claim.name()));
        return format!("{about}\n{}", proved.concat());
    }
    let some = if tried.all { "all" } else { "some" };
    format!(
        "{about}\nUNKNOWN: {why}\nsimulated: {geometries} geometries, {some} of the box: {as_claimed} did as claimed, \
         {refused} were refused, {given_up} were not run to their end\n"
    )
}

/// `1`, `1 and 2`, `1, 2 and 3`
fn list(ks: &[u32]) -> String {
    let words: Vec<String> = ks.iter().map(u32::to_string).collect();
    match &words[..] {
        [rest @ .., last] if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        _ => words.concat(),
    }
}

fn bits(ks: &[u32]) -> String {
    format!("{} {}", list(ks), if ks == [1] { "bit" } else { "bits" })
}

/// What is known of each of these: the geometries that were simulated did as claimed, those that were refused did
/// nothing.
pub(super) fn of_least_widths(tried: &[Tried]) -> String {
    let same: Vec<u32> = tried.iter().filter(|tried| tried.is_whole()).map(|tried| tried.k).collect();
    let mut text = String::new();
    if !same.is_empty() {
        text += &format!("simulated: the same for every geometry of {}\n", bits(&same));
    }
    for tried in tried.iter().filter(|tried| !tried.is_whole()) {
        let k = bits(&[tried.k]);
        let Tried { geometries, as_claimed, refused, given_up, .. } = tried;
        let why = tried.refusal.as_ref().map(|why| format!(": {why}")).unwrap_or_default();
        text += &match (*geometries, *refused) {
            (0, _) if tried.refusal.is_some() => format!("nothing claimed: there is no such hardware for {k}{why}\n"),
            (0, _) => format!("nothing claimed: there are no geometries of {k}\n"),
            (all, refused) if all == refused => {
                format!("nothing claimed: every one of {all} geometries of {k} is refused{why}\n")
            }
            _ => format!(
                "simulated: the same for {as_claimed} of {geometries} geometries of {k}; {refused} refused, {given_up} not \
                 run to their end{why}\n"
            ),
        };
    }
    text
}

#[cfg(test)]
mod tests {
    use crate::models::find;
    use crate::prove::{Certificate, Proof};
    use crate::study::proof::unproved;

    use super::*;

    /// What two kinds of geometry come to, the second of which may overflow.
    fn attempts(violated: &[(usize, String)]) -> Vec<Attempt> {
        let model = find("ppc-line").expect("a model");
        let kinds = model.claims.expect("claims").geometries.kinds();
        let proof = |violated: &[(usize, String)]| Proof { violated: violated.to_vec(), ..Proof::default() };
        let own = [proof(&[]), proof(violated)];
        kinds.into_iter().zip(own).map(|(kind, proof)| (kind, proof, Certificate::default())).collect()
    }

    #[test]
    fn nothing_is_proved_that_holds_only_as_long_as_nothing_overflows() {
        let scope = Scope { about: "line".to_owned(), widths: "for all k".to_owned() };
        let text = of_steps(&scope, &attempts(&[(0, "x >= 0".to_owned())]), false);
        assert!(!text.contains("PROVED"), "{text}");
        assert!(text.contains("not proved: no register overflows (not for 1 of 2 kinds of geometry)\n"), "{text}");
        let conditional = "not proved: the end point is reached exactly (only as long as no register overflows)\nnot proved: every block";
        assert!(text.contains(conditional), "{text}");
        assert_eq!(unproved(&attempts(&[(0, String::new())])).len(), 3);
        assert!(unproved(&attempts(&[])).is_empty() && unproved(&[]).len() == 3);
    }
}
