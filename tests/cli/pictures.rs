//! Windows of a wave as pictures: SVG and WaveJSON of `stepwave show`.

use std::collections::BTreeMap;

use roxmltree::{Document, Node};
use serde_json::Value as Json;
use stepwave::trace::read::{Value, Wave};

use super::Folder;
use super::show::ICARUS;

/// Pixels of a character of the widest of the fonts of the picture.
const LETTER: f64 = 12.0 * 0.602;

/// A group of an SVG that has moved its content down.
fn groups<'a, 'd>(node: Node<'a, 'd>) -> impl Iterator<Item = (f64, Node<'a, 'd>)> {
    node.children().filter(|node| node.has_tag_name("g")).map(|node| {
        let moved = node.attribute("transform").unwrap().strip_prefix("translate(0 ").unwrap();
        (moved.strip_suffix(')').unwrap().parse().unwrap(), node)
    })
}

fn number(node: Node<'_, '_>, name: &str) -> f64 {
    node.attribute(name).unwrap().parse().unwrap()
}

/// The text that a reader sees.
fn seen(node: Node<'_, '_>) -> String {
    node.children().filter_map(|node| if node.is_text() { node.text() } else { None }).collect()
}

/// All numbers of a path in which only M, L, H and V occur, as points.
fn points(path: &str) -> Vec<[f64; 2]> {
    let spaced: String =
        path.chars().flat_map(|c| if c.is_ascii_alphabetic() { vec![' ', c, ' '] } else { vec![c] }).collect();
    let mut words = spaced.split_whitespace();
    let (mut at, mut points, mut command) = ([0.0, 0.0], Vec::new(), "");
    while let Some(word) = words.next() {
        let mut value = word.parse::<f64>().ok();
        if value.is_none() {
            command = word;
            value = words.next().map(|word| word.parse().unwrap());
        }
        match command {
            "M" | "L" => at = [value.unwrap(), words.next().unwrap().parse().unwrap()],
            "H" => at[0] = value.unwrap(),
            "V" => at[1] = value.unwrap(),
            other => panic!("{other} in {path}"),
        }
        points.push(at);
    }
    points
}

/// What a reader of the picture sees of every signal in every cell: `0` and `1` by the height of a line, other values by the
/// text between two lines. `cell` pixels are a cell.
fn read_off(svg: &str, cell: f64) -> BTreeMap<String, Vec<String>> {
    let document = Document::parse(svg).unwrap();
    let mut rows: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (_, line) in groups(document.root_element()) {
        let left =
            line.children().filter(|node| node.has_tag_name("text")).nth(1).map(|node| number(node, "x")).unwrap();
        for (_, row) in groups(line) {
            let texts: Vec<Node<'_, '_>> = row.children().filter(|node| node.has_tag_name("text")).collect();
            let drawn = row.children().filter(|node| node.has_tag_name("path"));
            let cells = rows.entry(seen(texts[0])).or_default();
            for path in drawn {
                let points = points(path.attribute("d").unwrap());
                let [from, to] = [f64::min, f64::max].map(|of| points.iter().map(|point| point[0]).reduce(of).unwrap());
                // Slants go less than a third of a cell over the bounds.
                let [from, to] = [from, to].map(|x| ((x - left) / cell).round());
                let [top, bottom] = [f64::min, f64::max].map(|of| {
                    let level = points.windows(2).filter(|pair| pair[1][0] - pair[0][0] > cell / 2.0);
                    level.flat_map(|pair| [pair[0][1], pair[1][1]]).reduce(of).unwrap()
                });
                let middle = left + (from + to) / 2.0 * cell;
                let text = texts[1..].iter().find(|text| (number(**text, "x") - middle).abs() < 0.1);
                let value = match text {
                    Some(text) => seen(*text),
                    None if (top, bottom) == (20.0, 20.0) => "0".to_owned(),
                    None if (top, bottom) == (4.0, 4.0) => "1".to_owned(),
                    None => panic!("a value without text at {middle}: {svg}"),
                };
                let mut at = from;
                while at < to {
                    cells.push(value.clone());
                    at += 1.0;
                }
            }
        }
    }
    rows
}

/// No two texts touch, and none leaves the picture: each is as wide as its letters, 12 high.
fn nothing_overlaps(svg: &str) {
    let document = Document::parse(svg).unwrap();
    let root = document.root_element();
    let mut boxes: Vec<([f64; 4], String)> = Vec::new();
    let mut take = |y: f64, node: Node<'_, '_>| {
        for text in node.children().filter(|node| node.has_tag_name("text")) {
            let (shown, x, base) = (seen(text), number(text, "x"), y + number(text, "y"));
            let wide = shown.chars().count() as f64 * LETTER;
            let left = if text.attribute("text-anchor").is_some() { x - wide / 2.0 } else { x };
            boxes.push(([left, base - 10.0, left + wide, base + 2.0], shown));
        }
    };
    for (y, line) in groups(root) {
        take(y, line);
        groups(line).for_each(|(inner, row)| take(y + inner, row));
    }
    for (index, (a, text)) in boxes.iter().enumerate() {
        assert!(a[0] >= 0.0 && a[2] <= number(root, "width") && a[3] <= number(root, "height"), "{text}: {svg}");
        for (b, other) in &boxes[..index] {
            let apart = a[2] <= b[0] || b[2] <= a[0] || a[3] <= b[1] || b[3] <= a[1];
            assert!(apart, "{text} and {other} overlap: {svg}");
        }
    }
}

#[test]
fn the_svg_shows_the_values_of_the_step_table_and_no_text_overlaps() {
    let folder = Folder::new();
    let table = folder.good("run ppc-line --to 6,4 --vcd line.vcd --steps -");
    // Cells have the 8 characters that COMPUTE and its bound need.
    let shown = folder
        .run("show line.vcd --to 41 --signals *.x --signals *.y --signals f --signals beat --signals take_x --svg -");
    assert_eq!(shown.code, 0, "{shown:?}");
    nothing_overlaps(&shown.out);
    let rows = read_off(&shown.out, 8.0 * 7.5);
    let names: Vec<&str> = rows.keys().map(String::as_str).collect();
    assert_eq!(names, ["axis_x.x", "axis_y.y", "beat", "f", "take_x"]);
    let heads: Vec<&str> = table.lines().next().unwrap().split(',').collect();
    let wave = Wave::open(folder.path("line.vcd")).unwrap();
    for line in table.lines().skip(1) {
        let values: Vec<&str> = line.split(',').collect();
        let clock: usize = values[1].parse().unwrap();
        for (name, row) in [("x", "axis_x.x"), ("y", "axis_y.y"), ("f", "f")] {
            let column = heads.iter().position(|head| *head == name).unwrap();
            assert_eq!(rows[row].get(clock).map(String::as_str), Some(values[column]), "{name} at clock {clock}");
        }
    }
    // A bit and the states, at every clock, as the wave has them.
    for (name, row) in [("ppc_line.take_x", "take_x"), ("ppc_line.beat", "beat")] {
        let signal = wave.find(name).unwrap();
        assert_eq!(rows[row].len() as u64, wave.cycles().unwrap());
        for (clock, value) in (0..).zip(&rows[row]) {
            let Ok(Some(Value::Bits(bits))) = wave.value_at_cycle(signal, clock) else { panic!("{name} at {clock}") };
            let bits: String = bits.digits().collect();
            let states = folder.read("line.beat.states");
            let named = states.lines().filter_map(|line| line.split_once(' ')).find(|(known, _)| *known == bits);
            let wanted = named.map_or(bits.as_str(), |(_, name)| name);
            assert_eq!(value, wanted, "{name} at clock {clock}");
        }
    }
}

/// A lane, expanded as WaveDrom's description of the format says: `.` repeats the value before, `=` takes the next
/// text.
fn expanded(lane: &Json) -> Vec<String> {
    let mut data = lane["data"].as_array().into_iter().flatten().map(|text| text.as_str().unwrap().to_owned());
    let mut values: Vec<String> = Vec::new();
    for letter in lane["wave"].as_str().unwrap().chars() {
        values.push(match letter {
            '.' => values.last().unwrap().clone(),
            '=' => data.next().unwrap(),
            bit @ ('0' | '1' | 'x' | 'z') => bit.to_string(),
            other => panic!("{other} in {lane}"),
        });
    }
    assert_eq!(data.next(), None, "{lane}");
    values
}

/// A value as `--radix binary` writes it.
fn binary(value: Value<'_>) -> String {
    let Value::Bits(bits) = value else { panic!("{value}") };
    let digits: String = bits.digits().collect();
    match digits.chars().next().unwrap() {
        same @ ('x' | 'z') if digits.chars().all(|digit| digit == same) => same.to_string(),
        _ => digits,
    }
}

#[test]
fn wavejson_expanded_gives_back_every_value_of_the_wave() {
    let folder = Folder::new();
    folder.run("run ppc-line --to 6,4 --width f=3 --vcd trap.vcd");
    std::fs::remove_file(folder.path("trap.beat.states")).unwrap();
    folder.write("c.vcd", ICARUS);
    let mixed = "$var wire 1 ! clk $end $var wire 4 a v $end $var wire 1 b w $end $enddefinitions $end\n#0\n0!\nbx a\nzb\n\
        #1\n1!\nb1x a\n#2\n0!\n#3\n1!\nbz a\nub\n#4\n0!\n#5\n1!\nb1 a\nxb\n#6\n0!\n";
    folder.write("mixed.vcd", mixed);
    for (file, from, to) in [("trap", 0, 5), ("trap", 3, 5), ("c", 0, 6), ("mixed", 0, 3)] {
        let json = folder.run(&format!("show {file}.vcd --radix binary --from {from} --to {to} --wavedrom -"));
        assert_eq!(json.code, 0, "{json:?}");
        let json: Json = serde_json::from_str(&json.out).unwrap();
        assert_eq!((&json["head"]["tick"], json["config"]["hscale"].as_u64() >= Some(1)), (&Json::from(from), true));
        let wave = Wave::open(folder.path(&format!("{file}.vcd"))).unwrap();
        let shown: Vec<usize> = (0..wave.signals().len()).filter(|&signal| !wave.is_clock(signal)).collect();
        let lanes = json["signal"].as_array().unwrap();
        assert_eq!(lanes.len(), shown.len());
        for (lane, signal) in lanes.iter().zip(shown) {
            let path = &wave.signals()[signal].path;
            assert!(path.ends_with(lane["name"].as_str().unwrap()), "{path}: {lane}");
            let wanted: Vec<String> =
                (from..=to).map(|clock| binary(wave.value_at_cycle(signal, clock).unwrap().unwrap())).collect();
            assert_eq!(expanded(lane), wanted, "{path}");
        }
    }
    // States by their names, and times as a lane.
    folder.good("run ppc-line --to 3,2 --vcd line.vcd");
    let json: Json = serde_json::from_str(&folder.run("show line.vcd --to 5 --signals beat --wavedrom -").out).unwrap();
    assert_eq!(expanded(&json["signal"][0]), ["IDLE", "JUDGE", "FEED", "COMPUTE", "COMPARE", "JUDGE"]);
    let json: Json =
        serde_json::from_str(&folder.run("show c.vcd --by-time --from 50000 --signals tb.clk --wavedrom -").out)
            .unwrap();
    let lanes: Vec<Vec<String>> = json["signal"].as_array().unwrap().iter().map(expanded).collect();
    assert_eq!(lanes, [["50000", "55000", "60000"], ["0", "1", "0"]]);
    assert_eq!(json["head"], serde_json::json!({ "text": "time 50000 to 60000, in units of 1 ps" }));
}

#[test]
fn unknown_values_are_hatched_and_long_ones_cut_with_the_whole_next_to_them() {
    let folder = Folder::new();
    let vcd = "$var wire 1 ! clk $end $var wire 40 a a<b&c $end $var wire 1 b z $end $enddefinitions $end\n#0\n0!\nbx a\nzb\n\
        #1\n1!\nb1111111111111111111111111111111111111111 a\n1b\n#2\n0!\n#3\n1!\nb0 a\nxb\n#4\n0!\n";
    folder.write("c.vcd", vcd);
    let svg = folder.run("show c.vcd --svg -").out;
    nothing_overlaps(&svg);
    let document = Document::parse(&svg).unwrap();
    let texts: Vec<String> = document.descendants().filter(|node| node.has_tag_name("text")).map(seen).collect();
    assert_eq!(texts, ["clock", "0", "a<b&c", "x", "109951…", "0", "z", "x"]);
    let titles: Vec<String> = document.descendants().filter(|node| node.has_tag_name("title")).map(seen).collect();
    assert_eq!(titles, ["clock 0 to 2", "1099511627775"]);
    let hatched = document.descendants().filter(|node| node.attribute("fill") == Some("url(#hatch)"));
    assert_eq!(hatched.count(), 2);
    // z is a red line at half height.
    let lines = document.descendants().filter(|node| node.attribute("stroke") == Some("#b00020"));
    let flat = |node: &Node<'_, '_>| points(node.attribute("d").unwrap()).iter().all(|point| point[1] == 12.0);
    assert_eq!(
        lines.filter(|node| !node.has_tag_name("pattern") && node.attribute("fill").is_some()).filter(flat).count(),
        1
    );
}

#[test]
fn pictures_are_outputs_as_all_others_and_leave_standard_output_to_data() {
    let folder = Folder::new();
    folder.write("c.vcd", ICARUS);
    let text = folder.good("show c.vcd");
    assert_eq!(folder.good("show c.vcd --svg c.svg --wavedrom c.json"), text);
    assert_eq!(folder.files(), ["c.json", "c.svg", "c.vcd"]);
    let ran = folder.run("show c.vcd --svg -");
    assert_eq!((ran.out, ran.err), (folder.read("c.svg"), text));
    let refused = |words: &str, hint: &str| {
        let ran = folder.run(words);
        assert!((ran.code, ran.out.as_str()) == (2, "") && ran.err.contains(hint), "{ran:?}");
    };
    folder.write("c.n.states", "0011 THREE\n");
    refused("show c.vcd --svg c.n.states", "which this command reads and would destroy");
    folder.write("wave", ICARUS);
    refused("show wave --wavedrom wave", "which this command reads and would destroy");
    refused("show c.vcd --svg - --wavedrom -", "two outputs cannot both go to standard output");
    refused(
        "show c.vcd --svg c.json",
        "--svg writes SVG, but c.json has the ending of JSON: give --wavedrom c.json, or c.svg",
    );
    let mut long = "$var wire 1 ! clk $end $enddefinitions $end\n".to_owned();
    (0..20_004).for_each(|time| long += &format!("#{time}\n{}!\n", time % 2));
    folder.write("long.vcd", &long);
    refused("show long.vcd --signals clk --to 20000 --svg l.svg", "at most 10000 can be read; give --from and --to");
    assert!(!folder.files().contains(&"l.svg".to_owned()));
}
