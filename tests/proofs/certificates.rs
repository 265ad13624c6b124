//! Files of certificates: what they are about, what they prove, and files that are made to take long.

use std::fmt::Write as _;
use std::time::{Duration, Instant};

use stepwave::models::{Options, find};
use stepwave::proof::{CheckError, Effort, Proposition, check};
use stepwave::study::Extent;
use stepwave::study::proof::{Narrower, search};

use crate::cli::{Folder, Ran};

#[test]
fn what_is_not_claimed_is_no_failure_and_what_is_proved_has_its_certificate() {
    let folder = Folder::new();
    let printed = folder.good("prove dda-arc --preset full --certificate arc.cert");
    assert!(printed.contains("PROVED for all k: no register overflows\n"), "{printed}");
    // Of blocks that never end nothing is proved.
    assert!(
        printed.contains("PROVED for all k: the end point is reached exactly by every block that ends\n"),
        "{printed}"
    );
    assert!(printed.contains("not claimed: every block ends\n"), "{printed}");
    let checked = folder.good("prove check arc.cert");
    assert!(checked.contains("not claimed: every block ends\n"), "{checked}");
    // With other remainders at first it may stall.
    for preset in ["--any-preset", "--preset jrx=half,jry=zero", "--preset 3"] {
        let printed = folder.good(&format!("prove dda-arc {preset}"));
        assert!(printed.contains("not claimed: every block ends\n"), "{printed}");
    }
}

/// What is proved of every k is also looked at: every arc of 5 bits inside a quadrant with both ends on the circle ends there.
#[test]
fn arcs_of_integrators_are_proved_to_end_and_do() {
    assert_arcs_end("half");
}

#[test]
#[ignore = "exhaustive"]
fn arcs_of_integrators_that_begin_empty_are_proved_to_end_and_do() {
    assert_arcs_end("zero");
}

fn assert_arcs_end(preset: &str) {
    let folder = Folder::new();
    let printed = folder.good(&format!("prove dda-arc --preset {preset} --certificate arc.cert"));
    let checked = folder.good("prove check arc.cert");
    for said in [printed, checked] {
        assert!(said.contains("PROVED for all k: every block ends\n"), "{said}");
    }
    let model = find("dda-arc").unwrap();
    let choices = Options::parse(["--preset", preset]).unwrap();
    let survey = search(model, &model.claims.unwrap(), &choices, &Narrower::new(), 3..=5, |_| true);
    assert_eq!(survey.found, None);
    assert!(survey.tried.iter().all(|tried| tried.is_whole()), "{:?}", survey.tried);
}

#[test]
fn a_certificate_without_one_kind_of_geometry_proves_nothing_of_the_box() {
    let folder = Folder::new();
    folder.good("prove ppc-line --certificate line.cert");
    // Without the last kind nothing is proved of the box; the others are checked all the same.
    let text = folder.read("line.cert");
    let (before, _) = text.split_once("kind Q4\n").unwrap();
    std::fs::write(folder.path("part.cert"), before).unwrap();
    let ran = folder.run("prove check part.cert");
    assert_eq!(ran.code, 1, "{ran:?}");
    assert!(ran.out.contains("not proved: no register overflows (not for 1 of 4 kinds of geometry)\n"), "{ran:?}");
    assert!(ran.err.contains("part.cert does not prove: no register overflows, "), "{ran:?}");
}

#[test]
fn a_check_names_the_hardware_its_options_and_narrower_registers() {
    let folder = Folder::new();
    folder.good("prove ppc-line --beats 1 --on-overflow wrap --narrower x=1,y=1 --certificate line.cert");
    let checked = folder.good("prove check line.cert");
    let hardware = "ppc-line --beats 1 --on-overflow wrap with x 1 bit narrower and with y 1 bit narrower: every line ";
    assert!(checked.starts_with(hardware), "{checked}");
}

#[test]
fn a_certificate_whose_header_is_not_one_hardware_is_refused() {
    let folder = Folder::new();
    folder.good("prove ppc-line --width 6 --travel 40,20 --certificate box.cert");
    let text = folder.read("box.cert");
    assert!(text.contains("option --width\noption 6\noption --box\noption -40..40x-20..20\n"), "{text}");
    assert!(folder.good("prove check box.cert").starts_with("ppc-line --width 6 --box -40..40x-20..20: "));
    folder.good("prove dda-line --any-preset --certificate any.cert");
    let any = folder.read("any.cert");
    assert!(folder.good("prove check any.cert").starts_with("dda-line --any-preset: "));
    let head = |text: &str, from: &str, to: &str| text.replacen(from, to, 1);
    for (what, text, hint) in [
        ("narrower at widths", head(&text, "\nkind", "\nnarrower 1 f\nkind"), "--narrower is for hardware of every k"),
        ("preset at widths", head(&text, "option --box", "option --any-preset\noption --box"), "--any-preset is for"),
        ("two presets", head(&any, "option", "option --preset\noption half\noption"), "is not hardware alone"),
        ("travel", head(&text, "--box\noption -40..40x-20..20", "--travel\noption 40"), "is not hardware alone"),
        (
            "order",
            head(&any, "option --any-preset", "option --any-preset\noption --beats\noption 1"),
            "is not hardware",
        ),
        ("value", head(&text, "option 6", "option six"), "is not hardware alone"),
        ("model", head(&text, "ppc-line", "ppc-lime"), "there is no model 'ppc-lime'"),
    ] {
        let (ran, _) = timed(&folder, &text);
        assert!(ran.code == 2 && ran.out.is_empty() && ran.err.contains(hint), "{what}: {ran:?}");
    }
}

#[test]
fn a_certificate_of_the_library_is_that_of_the_command() {
    let folder = Folder::new();
    let asked = Proposition::of(find("cim-line").unwrap()).extent("5".parse::<Extent>().unwrap());
    let verdict = asked.prove(&Effort { certificate: true, ..Effort::default() }).unwrap();
    folder.good("prove cim-line --box 5 --certificate line.cert");
    let certificate = verdict.certificate().unwrap().to_string();
    assert_eq!(certificate, folder.read("line.cert"));
    assert!(check(&certificate).unwrap().is_proved());
    assert!(matches!(check("line"), Err(CheckError::File(_))));
}

/// A check, and how long it took.
fn timed(folder: &Folder, text: &str) -> (Ran, Duration) {
    std::fs::write(folder.path("own.cert"), text).unwrap();
    let start = Instant::now();
    let ran = folder.run("prove check own.cert");
    (ran, start.elapsed())
}

#[test]
fn a_wrong_line_is_refused_about_as_fast_as_a_good_file_is_accepted() {
    let folder = Folder::new();
    folder.good("prove ppc-line --certificate line.cert");
    let text = folder.read("line.cert");
    let (good, usual) = timed(&folder, &text);
    assert_eq!(good.code, 0);
    let limit = 4 * usual + Duration::from_secs(2);
    let lines: Vec<&str> = text.lines().collect();
    let kind = lines.iter().position(|line| *line == "kind Q2").unwrap();
    let answers: Vec<usize> = (kind..lines.len()).filter(|place| lines[*place].starts_with("answer")).collect();
    for place in [answers[0], answers[20], answers[45]] {
        for wrong in ["modes", "answer -", "answer (1*0)", "modes 0", "clause v12", "equal v4 1"] {
            let mut changed = lines.clone();
            changed.insert(place, wrong);
            let (ran, took) = timed(&folder, &(changed.join("\n") + "\n"));
            assert!((1..=2).contains(&ran.code) && !ran.out.contains("PROVED"), "{wrong} at {place}: {ran:?}");
            assert!(took < limit, "{wrong} at {place}: {took:?}, a good one {usual:?}");
        }
    }
}

#[test]
fn small_files_that_are_made_to_take_long_are_refused_in_time() {
    let folder = Folder::new();
    folder.good("prove ppc-line --certificate line.cert");
    let text = folder.read("line.cert");
    let head = text.split_once("kind Q1\n").unwrap().0.to_owned();
    let first = text.split_once("answer").unwrap().0.to_owned();
    let many = |line: &str, count: usize| vec![line; count].join("\n") + "\n";
    let mut fractions = format!("{first}answer (");
    for place in 0..200 {
        let _ = write!(fractions, "1/{}7*{} ", 10_u64.pow(17) + 2 * place, place % 9);
    }
    fractions += ")\n";
    let digits = format!("{first}answer ({}*1)\n", "9".repeat(10_000));
    for (what, text, hint) in [
        ("open questions", format!("{first}{}", many("answer -", 400_000)), "does not prove"),
        ("fractions", fractions, "does not prove"),
        ("digits", digits, "cannot be read"),
        ("equalities", format!("{head}kind Q1\nmodes\n{}", many("equal v4 v4", 100_000)), "cannot be read"),
        ("clauses", format!("{head}kind Q1\nmodes\n{}", many("clause v4", 100_000)), "cannot be read"),
        ("modes", format!("{head}kind Q1\n{}", many("modes", 100_000)), "cannot be read"),
        ("kinds", format!("{head}{}", many("kind Q1", 100_000)), "is one too many"),
        ("strange kinds", format!("{head}kind Q9\n"), "has no kind Q9"),
        ("powers", format!("{first}answer -\nmodes\nclause {}\n", vec!["v4"; 4000].join("*")), "cannot be read"),
        ("brackets", format!("{first}answer {}\n", "[0 ".repeat(2000)), "cannot be read"),
        ("size", format!("{first}{}", many("answer -", 600_000)), "MiB"),
        (
            "options",
            text.replacen("model ppc-line\n", "model ppc-line\noption --details\n", 1),
            "is not hardware alone",
        ),
        ("models", text.replacen("model ppc-line\n", "model ppc-line\nmodel ppc-arc\n", 1), "cannot be read"),
        (
            "blocks",
            format!("stepwave certificate 1\nmodel dpm-line\n{}", many("counted 16 Q1\ncounted 15 Q1", 50_000)),
            "does not say",
        ),
    ] {
        let (ran, took) = timed(&folder, &text);
        assert!((1..=2).contains(&ran.code) && ran.err.contains(hint), "{what}: {ran:?}");
        assert!(took < Duration::from_secs(20), "{what}: {took:?}");
    }
}
