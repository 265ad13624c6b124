//! `--html`: a page is one file that needs nothing else, and holds what the other outputs hold. What a browser makes of it
//! is looked at by `.ci/browser`.

use base64::Engine as _;
use serde_json::{Value, json};

use super::{Folder, engines, good, refused};

/// The description of each run in a page.
fn runs(page: &str) -> Vec<Value> {
    let texts = page.split("class=\"run\"").skip(1).map(|rest| rest.split(['>', '<']).nth(1).unwrap());
    let run = |text: &str| {
        let packed = base64::engine::general_purpose::STANDARD.decode(text).unwrap();
        let all = miniz_oxide::inflate::decompress_to_vec_zlib(&packed).unwrap();
        let (length, rest) = all.split_first_chunk().unwrap();
        serde_json::from_slice(&rest[..u32::from_le_bytes(*length) as usize]).unwrap()
    };
    texts.map(run).collect()
}

/// Dotted paths of the signals of a run.
fn paths(run: &Value) -> Vec<String> {
    let path = |signal: &Value| {
        let scopes = signal["scopes"].as_array().unwrap().iter();
        let names: Vec<&str> = scopes.chain([&signal["name"]]).map(|name| name.as_str().unwrap()).collect();
        names.join(".")
    };
    run["signals"].as_array().unwrap().iter().map(path).collect()
}

#[test]
fn a_page_refers_to_nothing_outside_of_it_and_is_small() {
    let folder = Folder::new();
    folder.good("run dda-line --to 8,6 --width 4 --html line.html");
    let page = folder.read("line.html");
    assert!(page.len() < 130_000, "{} bytes", page.len());
    for reference in ["http:", "https:", "//www", "src=", "@import", "url(", "fetch(", "XMLHttp", "import("] {
        assert!(!page.contains(reference), "{reference}");
    }
    let policy = page.split("content=\"default-src").nth(1).unwrap().split('"').next().unwrap();
    assert!(policy.starts_with(" 'none'; script-src 'sha256-") && !policy.contains("unsafe"), "{policy}");
    assert!(page.ends_with("</html>\n"));
}

#[test]
fn a_page_names_the_run_its_signals_and_what_is_wrong_as_the_other_outputs_do() {
    let folder = Folder::new();
    let ran = folder.run("run ppc-line --to 6,4 --width f=3 --html trap.html --vcd trap.vcd --json trap.json");
    assert_eq!(ran.code, 1);
    let [run] = &runs(&folder.read("trap.html"))[..] else { panic!("one run") };
    let report: Value = serde_json::from_str(&folder.read("trap.json")).unwrap();
    assert_eq!((&run["first"], &run["last"], &run["clocks"]), (&json!(0), &json!(15), &report["clocks"]));
    assert_eq!(run["events"][0]["clock"], report["overflow"]["events"][0]["clock"]);
    assert_eq!(run["worst"]["error"], report["path_error"]["greatest"]);
    assert_eq!(run["failures"], report["failures"]);
    assert!(ran.out.contains(run["summary"].as_str().unwrap()), "{}", run["summary"]);
    assert_eq!(run["steps"]["count"], 4);
    // The operands of the cell that stopped the run are shown, as in the wave.
    let vcd = folder.read("trap.vcd");
    let declared = vcd.lines().filter(|line| line.starts_with("$var") && !line.contains(" clk ")).count();
    let paths = paths(run);
    assert_eq!(paths.len(), declared);
    assert!(paths.contains(&"ppc_line.trap.exact".to_owned()), "{paths:?}");
}

#[test]
fn a_page_is_the_same_from_every_engine_and_next_to_every_wave() {
    let folder = Folder::new();
    let words = "run ppc-arc --from 40,9 --to -9,40 --ccw --html page.html --engine";
    let pages: Vec<String> = engines()
        .map(|engine| {
            folder.good(&format!("{words} {engine} --vcd wave.vcd"));
            let page = folder.read("page.html");
            folder.good(&format!("{words} {engine}"));
            assert!(page == folder.read("page.html"), "{engine}");
            page
        })
        .collect();
    assert!(pages.len() > 2 && pages.iter().all(|page| *page == pages[0]));
}

#[test]
fn a_page_shows_the_signals_and_the_window_that_are_asked_for() {
    let folder = Folder::new();
    folder.good("run dda-line --to 8,6 --html page.html --trace jr* --trace-from 4 --trace-to 9");
    let [run] = &runs(&folder.read("page.html"))[..] else { panic!("one run") };
    assert_eq!((&run["first"], &run["last"]), (&json!(4), &json!(9)));
    // Load words are inputs of these names.
    let expected = ["block.jrx_in", "block.jry_in", "axis_x.jrx", "axis_y.jry"].map(|path| format!("dda_line.{path}"));
    assert_eq!(paths(run), expected);
    // Row 3 of the step table is at clock 4, whose pulse is the first that the page has.
    assert_eq!((&run["steps"]["count"], &run["path"]["start"]), (&json!(6), &json!([1, 0])));
    refused("run dda-line --to 8,6 --html none.html --trace-from 400", &["the wave would be empty"]);
}

#[test]
fn a_page_shows_the_speed_where_it_is_asked_for() {
    let folder = Folder::new();
    for (option, rows) in [("", 0), ("--trace-speed", 1)] {
        folder.good(&format!("run dda-line --to 80,60 --html page.html {option}"));
        let [run] = &runs(&folder.read("page.html"))[..] else { panic!("one run") };
        let speeds = paths(run).into_iter().filter(|path| path == "dda_line.testbench.speed_e4").count();
        assert_eq!(speeds, rows, "{option}");
        // It is a row of the test bench: the netlist has no such net.
        let nets = run["nets"].as_array().unwrap().iter();
        assert_eq!(nets.filter(|net| net[0].is_null()).count(), rows, "{option}");
    }
}

#[test]
fn a_page_of_a_program_has_its_text_and_its_moves() {
    let folder = Folder::new();
    std::fs::write(
        folder.path("part.ngc"),
        "G21 G90 (a </script> of lines)\nN7 G1 X0.3 Y0.09 F300\nG2 X0.5 Y0.29 I0 J0.2\n",
    )
    .unwrap();
    folder.good("program part.ngc --method ppc --blu 0.01mm --html part.html --json part.json --steps part.csv");
    let page = folder.read("part.html");
    let [run] = &runs(&page)[..] else { panic!("one run") };
    let report: Value = serde_json::from_str(&folder.read("part.json")).unwrap();
    assert_eq!(run["text"][0], "G21 G90 (a </script> of lines)");
    let fields = |of: &Value, name: &str| of.as_array().unwrap().iter().map(|of| of[name].clone()).collect::<Vec<_>>();
    for name in ["line", "n", "kind", "begun", "clocks", "end_point", "path_error", "feed"] {
        assert_eq!(fields(&run["moves"], name), fields(&report["blocks"], name), "{name}");
    }
    // The first row of block 7 that is farthest from the line to (30, 9).
    let steps = folder.read("part.csv");
    let rows =
        steps.lines().skip(1).map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect::<Vec<i64>>());
    let of_line = rows.filter(|row| row[0] == 7).map(|row| {
        let [.., x, y, _] = row[..] else { panic!("{row:?}") };
        ((9 * x - 30 * y).abs(), row[2])
    });
    let worst = of_line.reduce(|worst, row| if row.0 > worst.0 { row } else { worst }).unwrap();
    assert_eq!(run["moves"][0]["worst_clock"], worst.1);
    assert_eq!(page.matches("</script>").count(), 3, "the comparison, the run, and the programs of the page");
}

#[test]
fn a_page_of_several_methods_has_each_of_them_and_the_table() {
    let folder = Folder::new();
    let out = folder.good("compare ppc-line dda-line --to 30,-17 --html both.html");
    let page = folder.read("both.html");
    let runs = runs(&page);
    let names: Vec<&str> = runs.iter().map(|run| run["headline"].as_str().unwrap()).collect();
    assert!(names.len() > 4 && names[0] == "ppc-line" && names.contains(&"dda-line --radix 10"), "{names:?}");
    let table: Vec<&str> = out.lines().skip(1).collect();
    assert_eq!(table.len(), names.len());
    for (run, line) in runs.iter().zip(table) {
        assert!(line.starts_with(run["headline"].as_str().unwrap()), "{line}");
        let clocks = run["clocks"].to_string();
        assert!(line.split_whitespace().any(|word| word == clocks), "{line}");
    }
    assert!(page.contains("\"title\":\"line (0, 0) to (30, -17)\""));
}

#[test]
fn a_page_goes_to_standard_output_alone_and_not_where_it_does_not_belong() {
    let page = good("run dda-line --to 8,6 --html -");
    assert!(page.starts_with("<!doctype html>") && page.ends_with("</html>\n"));
    for (words, says) in [
        ("run dda-line --to 8,6 --html wave.vcd", "give --vcd wave.vcd, or wave.html"),
        ("run dda-line --to 8,6 --vcd page.html", "give --html page.html, or page.vcd"),
        ("run dda-line --to 8,6 --html p.html --checkpoints s.json", "leave out --steps, --plot and --html"),
        ("run dda-line --to 8,6 --html - --steps -", "two outputs"),
        ("compare dda-line --to 8,6 --html none/p.html", "the folder none does not exist"),
    ] {
        refused(words, &[says]);
    }
}

/// The values of an attribute.
fn attributes(svg: &str, name: &str) -> Vec<String> {
    let head = format!(" {name}=\"");
    svg.split(&head).skip(1).map(|rest| rest.split('"').next().unwrap().to_owned()).collect()
}

#[test]
fn a_page_has_the_block_diagram_of_what_ran_or_says_why_not() {
    let folder = Folder::new();
    folder.good("run ppc-line --to 6,4 --html line.html");
    folder.good("export ppc-line --to 6,4 --schematic line.svg --netlist line.net");
    let [run] = &runs(&folder.read("line.html"))[..] else { panic!("one run") };
    assert_eq!(run["diagrams"], json!([{ "scope": "ppc_line", "svg": folder.read("line.svg") }]));
    assert!(run["diagram_note"].is_null());
    // Every register is shown at a wire, by the index of its net.
    let nets: Vec<u64> = run["nets"].as_array().unwrap().iter().filter_map(|net| net[0].as_u64()).collect();
    for signal in run["signals"].as_array().unwrap().iter().filter(|signal| signal["role"] == "register") {
        let net = nets[usize::try_from(signal["nets"][0].as_u64().unwrap()).unwrap()];
        let value = "<text class=\"value\" x=\"";
        let shown = folder
            .read("line.svg")
            .lines()
            .any(|line| line.starts_with(value) && line.contains(&format!("data-net=\"{net}\"")));
        assert!(shown, "{signal}");
    }
    folder.good("sim line.net --clocks 9 --html own.html");
    let [own] = &runs(&folder.read("own.html"))[..] else { panic!("one run") };
    assert!(own["diagrams"][0]["svg"].as_str().unwrap().contains(">take_x<"));
    // 400 registers in one scope.
    let mut wide = "netlist wide\n%0:1 = input\n".to_owned();
    (1..=400).for_each(|net| wide += &format!("%{net}:1 = register reset 0x0 next %{}\n", net - 1));
    wide += "name %0 in 0 \"d\" unsigned\n";
    folder.write("wide.net", &wide);
    folder.good("sim wide.net --clocks 3 --html wide.html");
    let [wide] = &runs(&folder.read("wide.html"))[..] else { panic!("one run") };
    let drawn = wide["diagrams"].as_array().unwrap();
    let svg = |of: &Value| of["svg"].as_str().unwrap().to_owned();
    assert!(svg(&drawn[0]).matches("class=\"closed\"").count() > 1, "{wide}");
    // Every closed box has a drawing, and every drawing but the first is that of a box; the registers are in them, each once.
    let mut boxes: Vec<String> = drawn.iter().flat_map(|of| attributes(&svg(of), "data-scope")).collect();
    boxes.sort_unstable();
    let mut scopes: Vec<String> = drawn[1..].iter().map(|of| of["scope"].as_str().unwrap().to_owned()).collect();
    scopes.sort_unstable();
    assert_eq!(boxes, scopes);
    let registers: usize = drawn.iter().map(|of| svg(of).matches("class=\"register\"").count()).sum();
    assert_eq!(registers, 400);
    // 400 inputs are in no group.
    let mut many = "netlist many\n".to_owned();
    (0..400).for_each(|net| many += &format!("%{net}:1 = input\nname %{net} in 0 \"d{net}\" unsigned\n"));
    folder.write("many.net", &many);
    folder.good("sim many.net --clocks 3 --html many.html");
    let [many] = &runs(&folder.read("many.html"))[..] else { panic!("one run") };
    let note = "many has 400 symbols in its block diagram, and 300 are the most: it has no scopes or groups of which one could be drawn alone";
    assert_eq!((&many["diagrams"], &many["diagram_note"]), (&Value::Null, &json!(note)));
}
