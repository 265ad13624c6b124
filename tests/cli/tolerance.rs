//! Arcs whose two radii differ, and comparisons that are given up.

use super::Folder;

/// From a manual of a motion chip: the radii are 538.516 and 540.745 BLU.
const ARC: &str = "--from 0,0 --to -702,299 --center -200,500 --cw";

#[test]
fn the_radii_of_an_arc_may_differ_by_the_tolerance_beyond_rounding() {
    let folder = Folder::new();
    for command in ["run ppc-arc", "run sampled-arc --step 100", "compare", "export ppc-arc --verilog -"] {
        let ran = folder.run(&format!("{command} {ARC}"));
        assert_eq!(ran.code, 2, "{command}");
        for part in ["538.516 BLU at the start", "540.745 BLU at the end", "accept it with --tolerance 1.229"] {
            assert!(ran.err.contains(part), "{command}: {}", ran.err);
        }
        assert_eq!(folder.run(&format!("{command} {ARC} --tolerance 1.2")).code, 2, "{command}");
    }
    for model in ["ppc-arc", "dda-arc --preset half", "cim-arc", "mindev-arc", "vector-arc"] {
        let out = folder.good(&format!("run {model} {ARC} --tolerance 1.229"));
        assert!(out.contains("end point (-702, 299) reached exactly"), "{model}: {out}");
        assert!(out.contains("the centre has moved to"), "{model}: {out}");
    }
    // Where the radii agree nothing moves, and a line has none.
    assert!(!folder.good("run ppc-arc --from 5,0 --to 0,5 --ccw --tolerance 3").contains("moved"));
    assert_eq!(folder.run("run ppc-line --to 6,4 --tolerance 3").code, 2);
}

#[test]
fn a_comparison_gives_up_runs_that_take_too_many_clocks() {
    let out = Folder::new().good("compare --to 5000,3000 --max-clocks 1000");
    let row = out.lines().find(|line| line.starts_with("ppc-line ")).unwrap();
    assert!(row.contains(" 1000 ") && row.ends_with("given up at --max-clocks"), "{row}");
}

#[test]
fn a_sweep_takes_the_tolerance_of_radii_too() {
    let folder = Folder::new();
    let row = |words: &str| {
        let out = folder.good(&format!("sweep ppc-arc {words} --csv -"));
        out.lines().nth(1).unwrap_or_default().to_owned()
    };
    assert!(row(ARC).contains(",refused,") && row(ARC).contains("--tolerance 1.229"));
    assert!(row(&format!("{ARC} --tolerance 1.2")).contains(",refused,"));
    let run: serde_json::Value =
        serde_json::from_str(&folder.good(&format!("run ppc-arc {ARC} --tolerance 1.229 --json -"))).unwrap();
    let wanted = format!(",done,{},{},702,377,-702,299,true,0.97924", run["clocks"], run["steps"]);
    assert!((run["path_error"]["greatest"].as_f64().unwrap() - 0.979_243).abs() < 1e-6);
    assert!(row(&format!("{ARC} --tolerance 1.229")).contains(&wanted), "{wanted}");
    folder.write("arcs.csv", "to_x,to_y,center_x,center_y,direction\n-702,299,-200,500,cw\n");
    assert!(row("--file arcs.csv --tolerance 1.229").contains(&wanted));
    assert!(row("--file arcs.csv").contains(",refused,"));
    // Of a coarse stage it is that of the chords, too.
    let chords = folder.good(&format!("sweep sampled-arc {ARC} --tolerance 5 --step 100 --csv -"));
    assert!(chords.starts_with("index,") && chords.contains(",tolerance,") && chords.contains(",done,"), "{chords}");
    assert!(folder.run("sweep ppc-line --to 6,4 --tolerance 3 --csv -").err.contains("no --tolerance"));
    assert_eq!(
        folder
            .good("sweep dda-helix --from 0,0,0 --to -702,299,9 --center -200,500 --cw --tolerance 2 --csv -")
            .matches(",done,")
            .count(),
        1
    );
}
