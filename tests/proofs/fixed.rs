//! Verdicts on one hardware of given widths over one box.

use crate::cli::Folder;

fn assert_proved(out: &str, how: &str) {
    for claim in ["no register overflows", "the end point is reached exactly", "every block ends"] {
        assert!(out.contains(&format!("PROVED at these widths{how}: {claim}\n")), "{out}");
    }
}

#[test]
fn a_width_alone_is_about_all_coordinates_of_so_many_bits() {
    let folder = Folder::new();
    // 7 · 7 end points but for the origin.
    let out = folder.good("prove ppc-line --width 2");
    assert_proved(&out, " (exhausted: 48 geometries)");
    assert!(out.starts_with("ppc-line --width 2: every line from the origin to coordinates of 2 bits\n"), "{out}");
    let out = folder.good("prove ppc-line --width 32");
    assert_proved(&out, "");
    assert!(out.contains("coordinates of 32 bits\n") && !out.contains("every k"), "{out}");
}

#[test]
fn a_travel_is_proved_by_the_form_for_every_k_or_refuted_by_a_run() {
    let folder = Folder::new();
    // F of a line takes k+1 bits: 11 of 10.
    assert_proved(&folder.good("prove ppc-line --width f=20 --travel 1000,600"), "");
    assert_proved(&folder.good("prove ppc-line --width f=11,e=20 --travel 1000"), "");
    let ran = folder.run("prove ppc-line --width f=10 --travel 1000 --vcd trap.vcd");
    assert!(ran.code == 1 && ran.out.starts_with("COUNTEREXAMPLE at k = 10: stepwave run ppc-line --to "), "{ran:?}");
    assert!(ran.err.contains("overflow of ppc_line.f"), "{ran:?}");
    assert!(folder.read("trap.vcd").starts_with("$version"));
    // -128 to 127 fit in 8 bits, 128 does not.
    assert_proved(&folder.good("prove ppc-line --width x=8 --travel 127 --on-overflow wrap"), "");
    let ran = folder.run("prove ppc-line --width x=8 --travel 128,3 --on-overflow wrap");
    assert!(ran.code == 1 && ran.err.contains("the counter x shows -128, 128 pulses were given"), "{ran:?}");
    // The form for every k needs room for 255; all of these fit.
    let out = folder.good("prove ppc-line --width x=8 --box -128..127x-9..9");
    assert_proved(&out, &format!(" (exhausted: {} geometries)", 256 * 19 - 1));
    assert!(out.contains("coordinates within -128..127x-9..9\n"), "{out}");
}

#[test]
fn a_small_box_of_narrow_registers_is_simulated_and_no_proof_is_searched_for() {
    let folder = Folder::new();
    // Of these arcs the largest radius inside a quadrant has F within 5 bits; the search for a proof took minutes.
    let out = folder.good("prove ppc-arc --width 5,yi=5,f=5 --travel 4,16");
    assert!(out.contains("PROVED at these widths (exhausted: "), "{out}");
    let ran = folder.run("prove ppc-arc --width 5,yi=5,f=4 --travel 4,16");
    assert!(ran.code == 1 && ran.out.starts_with("COUNTEREXAMPLE"), "{ran:?}");
}

#[test]
fn a_register_of_a_fixed_width_alone_is_too_narrow_somewhere_and_never_proved() {
    let folder = Folder::new();
    let ran = folder.run("prove ppc-line --width x=8 --on-overflow wrap");
    assert!(ran.code == 1 && !ran.out.contains("PROVED"), "{ran:?}");
    assert!(ran.out.starts_with("COUNTEREXAMPLE at k = 8: stepwave run ppc-line --to "), "{ran:?}");
    assert!(ran.err.contains("prove ppc-line --width x=8 --on-overflow wrap --box 7`"), "{ran:?}");
    let ran = folder.run("prove ppc-line --width f=9");
    assert!(ran.code == 1 && ran.out.starts_with("COUNTEREXAMPLE at k = 9: stepwave run ppc-line --to "), "{ran:?}");
}

#[test]
fn what_is_proved_at_given_widths_has_a_certificate_of_these_widths() {
    let folder = Folder::new();
    let printed = folder.good("prove ppc-line --width 12,f=14 --travel 1000,600 --certificate line.cert");
    assert_proved(&printed, "");
    assert_eq!(folder.good("prove check line.cert"), printed);
    assert!(printed.starts_with("ppc-line --width 12,f=14 --box -1000..1000x-600..600: "), "{printed}");
    // A bit less, and the proof is none of that hardware.
    let text = folder.read("line.cert");
    for (from, to) in [("12,f=14", "12,f=12"), ("-1000..1000", "-5000..1000")] {
        assert!(text.contains(from));
        std::fs::write(folder.path("other.cert"), text.replacen(from, to, 1)).unwrap();
        let ran = folder.run("prove check other.cert");
        assert!(ran.code == 1 && !ran.out.contains("PROVED"), "{ran:?}");
    }
    let printed = folder.good("prove ppc-line --width f=14 --box 10 --certificate ten.cert");
    assert_eq!(folder.good("prove check ten.cert"), printed);
    // Simulation is not a proof that could be checked again.
    let printed = folder.good("prove ppc-line --width 2 --certificate two.cert");
    assert!(printed.contains("no certificate: "), "{printed}");
    assert!(!folder.files().contains(&"two.cert".to_owned()));
}

#[test]
fn blocks_that_are_followed_have_given_widths_too() {
    let folder = Folder::new();
    let printed = folder.good("prove dpm-line --width 5 --certificate five.cert");
    assert_proved(&printed, "");
    assert_eq!(folder.good("prove check five.cert"), printed);
    let ran = folder.run("prove dpm-line --width 5,x=5");
    assert!(ran.code == 1 && ran.out.starts_with("COUNTEREXAMPLE at k = 5: "), "{ran:?}");
}

#[test]
fn bad_boxes_and_options_that_contradict_each_other_are_refused() {
    let folder = Folder::new();
    for (words, hint) in [
        ("prove ppc-line --travel 10mm", "give whole BLU"),
        ("prove ppc-line --travel 0", "give 1 or more"),
        ("prove ppc-line --travel -5", "give 1 or more"),
        ("prove ppc-line --travel 9 --box 4", "cannot be used with"),
        ("prove ppc-line --box 0..9", "a box of 1 axis is not proved: give two ranges, such as 0..9x0..9"),
        ("prove ppc-line --box 0..9x0..9x0..9", "give two"),
        ("prove ppc-line --width g=8 --box 4", "has no register g"),
        ("prove ppc-line --width g=8", "has no register g"),
        ("prove ppc-line --width 8 --narrower f=1", "--narrower is for hardware of every k"),
        ("prove dda-line --width 8 --any-preset", "--any-preset is for"),
        ("prove dpm-line --width 8 --bits 8", "--bits is for"),
        ("prove ppc-line --width 8 --solver cat", "--solver is for"),
    ] {
        let ran = folder.run(words);
        assert_eq!((ran.code, ran.out.as_str()), (2, ""), "{words}: {ran:?}");
        assert!(ran.err.contains(hint) && ran.err.lines().count() == 1, "{words}: {ran:?}");
    }
}

#[test]
fn a_model_that_claims_nothing_is_run_over_a_box() {
    let folder = Folder::new();
    let printed = folder.good("prove stepgen --width 8 --box 0..5x0..5");
    let head = "stepgen --width 8: lines from the origin, of the box 0..5x0..5, on the one hardware that serves them all\nPROVED at these widths: no operator";
    assert!(printed.starts_with(head) && printed.ends_with(" (35 geometries, exhausted)\n"), "{printed}");
    assert_eq!(
        folder.good("prove stepgen --width 3").lines().next(),
        Some(
            "stepgen --width 3: lines from the origin, with coordinates of 3 bits, on the one hardware that serves them all"
        )
    );
    let ran = folder.run("prove stepgen --width 8,acc=5 --box 0..5x0..5");
    assert!(ran.code == 1 && ran.out.contains("\nCOUNTEREXAMPLE: stepwave run stepgen --to "), "{ran:?}");
    assert!(ran.err.contains("overflow of stepgen."), "{ran:?}");
    for (words, hint) in [
        ("prove stepgen", "stepgen claims nothing for every k: give a box (--box 4)"),
        ("prove stepgen --width 8 --certificate a.cert", "--certificate does not go with the geometries of a box"),
    ] {
        let ran = folder.run(words);
        assert!(ran.code == 2 && ran.err.contains(hint), "{words}: {ran:?}");
    }
}
