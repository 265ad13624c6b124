//! `stepwave prove` as its users meet it.

use crate::cli::Folder;

#[test]
fn a_proof_is_printed_written_and_checked_again_alone() {
    let folder = Folder::new();
    let printed = folder.good("prove ppc-line --certificate line.cert");
    for claim in ["no register overflows", "the end point is reached exactly", "every block ends"] {
        assert!(printed.contains(&format!("PROVED for all k: {claim}\n")), "{printed}");
    }
    assert!(
        printed.contains("for every k from 3 to 52\n") && printed.contains("every geometry of 1 and 2 bits\n"),
        "{printed}"
    );
    assert_eq!(folder.files(), ["line.cert"]);
    let checked = folder.good("prove check line.cert");
    assert_eq!(checked, printed.split_inclusive("simulated").next().unwrap().replace("simulated", ""));
}

#[test]
fn options_go_with_the_certificate() {
    let folder = Folder::new();
    folder.good("prove dda-line --any-preset --certificate any.cert");
    folder.good("prove check any.cert");
    let half = folder.good("prove ppc-line --beats 1 --end-point per-axis --certificate one.cert");
    assert!(half.contains("PROVED"));
    assert!(folder.read("one.cert").contains("option --beats\noption 1\n"));
    folder.good("prove check one.cert");
}

#[test]
fn one_bit_narrower_is_refuted_with_a_command_and_a_wave() {
    let folder = Folder::new();
    let ran = folder.run("prove ppc-line --narrower f=1 --vcd trap.vcd");
    assert_eq!(ran.code, 1);
    let command = ran.out.trim().split_once(": stepwave ").unwrap();
    assert!(command.0.starts_with("COUNTEREXAMPLE at k = "), "{ran:?}");
    assert!(ran.err.contains("overflow of ppc_line.f at clock "), "{ran:?}");
    let wave = folder.read("trap.vcd");
    let again = folder.run(command.1);
    assert_eq!((again.code, folder.read("trap.vcd")), (1, wave));
    assert!(ran.err.contains(again.err.trim().trim_start_matches("stepwave: ")), "{ran:?} {again:?}");
}

#[test]
fn what_is_not_proved_is_said_with_exit_code_1_and_nothing_proved_has_no_certificate() {
    let folder = Folder::new();
    let ran = folder.run("prove dda-line --normalize --certificate line.cert");
    assert_eq!(ran.code, 1);
    assert!(ran.out.contains("not proved: every block ends (for none of 4 kinds of geometry)\n"), "{ran:?}");
    assert!(ran.out.contains("no certificate: nothing is proved\n"), "{ran:?}");
    assert!(ran.err.starts_with("stepwave: not proved: no register overflows, "), "{ran:?}");
    assert_eq!(folder.files(), [""; 0]);
}

#[test]
fn what_was_refused_is_not_claimed_to_be_simulated() {
    // 12 has four bits: of fewer there is no such preset.
    let printed = Folder::new().good("prove dda-line --preset 12");
    assert!(
        printed.contains("PROVED for k = 4 to 52: no register overflows\n") && !printed.contains("for all k"),
        "{printed}"
    );
    for (geometries, bits) in [(8, "1 bit"), (48, "2 bits"), (224, "3 bits")] {
        let line = format!("nothing claimed: every one of {geometries} geometries of {bits} is refused: ");
        assert!(printed.contains(&line), "{printed}");
    }
    assert!(!printed.contains("simulated"), "{printed}");
}

#[test]
fn standard_output_holds_the_file_alone_and_a_path_with_a_blank_is_one_word() {
    let folder = Folder::new();
    let wave = folder.run("prove ppc-line --narrower f=1 --vcd -");
    assert!(wave.code == 1 && wave.out.starts_with("$version") && !wave.out.contains("COUNTEREXAMPLE"), "{wave:?}");
    let step = folder.run("prove dda-line --normalize --vcd -");
    assert!(step.code == 1 && step.out.starts_with("$version") && !step.out.contains("INDUCTIVE"), "{step:?}");
    for words in ["prove ppc-line --certificate -", "prove dpm-line --bits 3 --certificate -"] {
        let certificate = folder.good(words);
        assert!(
            certificate.starts_with("stepwave certificate 1\n") && !certificate.contains("PROVED"),
            "{certificate}"
        );
        std::fs::write(folder.path("own.cert"), certificate).unwrap();
        folder.good("prove check own.cert");
    }
    let ran = folder.run_words(&["prove", "ppc-line", "--narrower", "f=1", "--vcd", "a trap.vcd"]);
    assert!(ran.code == 1 && ran.out.ends_with(" --vcd 'a trap.vcd'\n"), "{ran:?}");
    assert!(folder.read("a trap.vcd").starts_with("$version"));
}

/// What a signal holds first in a wave.
fn first(wave: &str, name: &str) -> String {
    let var = wave.lines().find(|line| line.starts_with("$var ") && line.split(' ').nth(4) == Some(name)).unwrap();
    let code = var.split(' ').nth(3).unwrap();
    let value = wave.lines().find(|line| line.starts_with('b') && line.ends_with(&format!(" {code}"))).unwrap();
    value[1..].split(' ').next().unwrap().to_owned()
}

#[test]
fn a_step_from_a_state_that_may_be_unreachable_is_reported_with_its_wave() {
    let folder = Folder::new();
    let ran = folder.run("prove dda-line --normalize --vcd step.vcd");
    assert_eq!(ran.code, 1);
    let mut lines = ran.out.lines().skip_while(|line| !line.starts_with("NOT INDUCTIVE at k = 3, Q1: "));
    let wrong = lines.next().unwrap().split_once("Q1: ").unwrap().1;
    let component = wrong.strip_suffix(" overflows").unwrap();
    let state = lines.next().unwrap();
    assert!(state.contains("that may be unreachable: busy = 1"), "{ran:?}");
    assert!(ran.out.contains(&format!("  overflow of {component} at clock ")), "{ran:?}");
    assert!(ran.err.ends_with("a step from a state that may be unreachable shows why\n"), "{ran:?}");
    let wave = folder.read("step.vcd");
    assert!(wave.contains(", from a state that may be unreachable $end\n"));
    for register in ["x", "y", "jvx", "jry"] {
        let printed = state.split(", ").find_map(|word| word.strip_prefix(&format!("{register} = "))).unwrap();
        let held = i64::from_str_radix(&first(&wave, register), 2).unwrap();
        assert_eq!(printed, held.to_string(), "{register}");
    }
    assert!(folder.files().contains(&"step.gtkw".to_owned()));
}

#[test]
fn presets_at_their_ends_refute_what_is_not_proved_for_any() {
    let folder = Folder::new();
    let ran = folder.run("prove dda-line --end-point longest --any-preset");
    assert!(ran.code == 1 && ran.out.starts_with("COUNTEREXAMPLE at k = "), "{ran:?}");
    let command = ran.out.trim().split_once(": stepwave ").unwrap().1;
    let again = folder.run(command);
    assert!(again.code == 1 && again.err.contains("was missed"), "{command}: {again:?}");
}

#[test]
fn bad_input_is_refused_in_a_sentence() {
    let folder = Folder::new();
    folder.good("prove ppc-line --certificate line.cert");
    let broken = folder.read("line.cert").replacen("answer (", "answer ((", 1);
    std::fs::write(folder.path("broken.cert"), broken).unwrap();
    std::fs::write(folder.path("other.cert"), "hello\n").unwrap();
    for (words, hint) in [
        ("prove", "required"),
        ("prove nonsense", "no model"),
        ("prove ppc-conic", "ppc-conic claims nothing for every k: give a box (--box 4)"),
        ("prove ppc-line --narrower g=1", "has no register g"),
        ("prove ppc-line --narrower f", "such as f=1"),
        ("prove ppc-line --narrower f=40", "cannot be 40 bits narrower"),
        ("prove ppc-line --preset half", "does not take --preset"),
        ("prove ppc-line --feed 600 --blu 0.01mm", "does not take --feed"),
        ("prove dpm-line --feed 600 --blu 0.01mm", "does not take --feed"),
        ("widths ppc-line --box 3 --feed 600 --blu 0.01mm", "does not take --feed"),
        ("prove check missing.cert", "cannot read missing.cert"),
        ("prove check other.cert", "does not begin with 'stepwave certificate 1'"),
        ("prove check broken.cert", "cannot be read"),
    ] {
        let ran = folder.run(words);
        assert_eq!((ran.code, ran.out.as_str()), (2, ""), "{words}: {ran:?}");
        assert!(ran.err.contains(hint) && ran.err.lines().count() == 1, "{words}: {ran:?}");
    }
}

/// A solver of this name in the folder, which says this and reads nothing.
#[cfg(unix)]
pub(super) fn solver(folder: &Folder, says: &str) -> String {
    use std::os::unix::fs::PermissionsExt;
    let path = folder.path("solver");
    std::fs::write(&path, format!("#!/bin/sh\necho '{says}'\n")).unwrap();
    std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o755)).unwrap();
    path.display().to_string()
}

#[test]
#[cfg(unix)]
fn a_solver_that_contradicts_a_proof_or_talks_nonsense_is_reported() {
    let folder = Folder::new();
    let command = solver(&folder, "unsat");
    let printed = folder.good(&format!("prove ppc-line --solver {command}"));
    assert!(printed.contains("says unsat of 48 geometries of 2 bits"), "{printed}");
    assert!(printed.contains("PROVED for all k"), "{printed}");
    let ran = folder.run(&format!("prove ppc-line --solver {}", solver(&folder, "sat")));
    assert_eq!(ran.code, 1);
    assert!(ran.err.contains("the solver says is wrong"), "{ran:?}");
    let ran = folder.run(&format!("prove ppc-line --solver {}", solver(&folder, "what?")));
    assert_eq!(ran.code, 2);
    assert!(ran.err.contains("said 'what?', neither sat nor unsat"), "{ran:?}");
    let ran = folder.run("prove ppc-line --solver there/is/no/such/solver");
    assert_eq!(ran.code, 2);
    assert!(ran.err.contains("cannot be run"), "{ran:?}");
    // One that says nothing is stopped, and the proof is had all the same.
    let start = std::time::Instant::now();
    let ran = folder.run_words(&["prove", "ppc-line", "--solver", "sleep 300", "--solver-seconds", "1"]);
    assert!(ran.out.starts_with("the solver 'sleep 300' was stopped after 1 s without an answer"), "{ran:?}");
    assert!(ran.code == 0 && ran.out.contains("PROVED for all k") && start.elapsed().as_secs() < 100, "{ran:?}");
    // One that talks without end and never listens.
    let ran = folder.run("prove ppc-line --solver yes");
    assert_eq!(ran.code, 2);
    assert!(ran.err.contains("said 'y'"), "{ran:?}");
    let ran = folder.run(&format!("prove dda-line --bits 16 --solver {}", solver(&folder, "unsat")));
    assert_eq!(ran.code, 2);
    assert!(ran.err.contains("more than 4096 geometries"), "{ran:?}");
}

#[test]
fn the_wave_of_a_counterexample_has_the_files_of_its_viewer_as_that_of_a_run() {
    let folder = Folder::new();
    let ran = folder.run("prove ppc-line --narrower f=1 -o trap.vcd --viewer both -q");
    assert_eq!((ran.code, ran.out.as_str()), (1, ""), "{ran:?}");
    let files = folder.files();
    for file in ["trap.vcd", "trap.gtkw", "trap.sucl"] {
        assert!(files.iter().any(|known| known == file), "{file}: {files:?}");
    }
    let surfer = folder.read("trap.sucl");
    folder.run("run ppc-line --to 1,3 --width 2,f=2 --vcd trap.vcd --viewer both");
    assert_eq!(folder.read("trap.sucl"), surfer);
    // A proof writes no wave, which is said where an older one might be taken for its own; a stream has no files next to it.
    folder.write("old.vcd", "old");
    let proved = folder.good("prove dda-line --vcd old.vcd");
    assert!(proved.ends_with("\nno counterexample: old.vcd is not written\n"), "{proved}");
    assert_eq!(folder.read("old.vcd"), "old");
    assert!(folder.run("prove ppc-line --viewer surfer").err.contains("--vcd"));
    let ran = folder.run("prove ppc-line --narrower f=1 --vcd - --viewer surfer");
    assert!(
        ran.code == 2 && ran.out.is_empty() && ran.err.contains("--viewer is about files next to a wave"),
        "{ran:?}"
    );
    let ran = folder.run("prove ppc-line --open");
    assert!(ran.code == 2 && ran.err.contains("there is nothing to show"), "{ran:?}");
}

#[test]
fn every_command_that_writes_a_wave_of_hardware_takes_a_viewer_and_opens_it() {
    let folder = Folder::new();
    for command in ["run", "program", "sim", "prove"] {
        let help = folder.good(&format!("{command} --help"));
        for option in ["--vcd", "--viewer", "--open", "--quiet", "--output"] {
            assert!(
                help.contains(&format!("{option} ")) || help.contains(&format!("{option}\n")),
                "{command} {option}"
            );
        }
    }
}
