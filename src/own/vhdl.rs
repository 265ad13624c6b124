//! What GHDL's Verilog does not say of the VHDL that it was made of: lines, signs, and which names are the author's.
//!
//! GHDL writes the place of a statement in a comment before it, calls results without a name `n12_o` and `n13_q`, and has
//! no signed nets. The JSON that Yosys makes of it gets all three back: the two operands and the result of a sum,
//! difference or product are of one type in VHDL, so that one declared name shows how all of them are read.

use std::collections::{HashMap, HashSet};

use serde_json::{Value, json};

/// The file that GHDL's Verilog is in.
pub(super) const OF_GHDL: &str = "written-by-ghdl.v";

/// The Verilog with operators of signed numbers as VHDL means them. GHDL 2 writes them without a sign, and says in a comment
/// which they are: `$signed(x) >> n`, which Verilog fills with zeros, `x / y; // sdiv`, and `x % y` for `rem` and for `mod`,
/// which has the sign of the divisor. An absolute value is written in VHDL.
pub(super) fn with_signs(verilog: &str) -> String {
    verilog.lines().map(|line| signed_operator(line).unwrap_or_else(|| line.to_owned()) + "\n").collect()
}

fn signed_operator(line: &str) -> Option<String> {
    if let Some((left, right)) = line.split_once(" <= std_logic_vector(abs $signed(") {
        let x = right.strip_suffix("));")?;
        return Some(format!("  assign {} = $signed({x}) < 0 ? -{x} : {x};", left.trim()));
    }
    let (left, right) = line.split_once(" = ")?;
    if let Some(shift) = right.strip_prefix("$signed(") {
        return Some(format!("{left} = $signed({}", shift.replacen(") >> ", ") >>> ", 1)));
    }
    let (code, remark) = right.split_once("; // ")?;
    let mut words = code.split(' ');
    let (Some(x), Some(_), Some(y), None) = (words.next(), words.next(), words.next(), words.next()) else {
        return None;
    };
    let rest = format!("$signed({x}) % $signed({y})");
    match remark.trim() {
        "sdiv" => Some(format!("{left} = $signed({x}) / $signed({y});")),
        "srem" => Some(format!("{left} = {rest};")),
        "smod" => Some(format!(
            "{left} = {rest} != 0 && $signed({x}) < 0 != $signed({y}) < 0 ? {rest} + $signed({y}) : {rest};"
        )),
        _ => None,
    }
}

/// The JSON with places, signs and names of the VHDL.
///
/// # Errors
/// It is not JSON.
pub(super) fn restored(json: &str, verilog: &str, vhdl: &[String]) -> Result<String, serde_json::Error> {
    let mut file: Value = serde_json::from_str(json)?;
    let (places, types) = (places(verilog), types(vhdl));
    for module in file["modules"].as_object_mut().into_iter().flat_map(serde_json::Map::values_mut) {
        for part in ["cells", "netnames", "memories"] {
            for item in module[part].as_object_mut().into_iter().flat_map(serde_json::Map::values_mut) {
                if let Some(Value::String(place)) = item["attributes"].get_mut("src") {
                    *place = moved(place, &places);
                }
            }
        }
        let mut signs = Signs::default();
        for (name, net) in module["netnames"].as_object_mut().into_iter().flatten() {
            let leaf = name.rsplit('.').next().unwrap_or(name);
            if is_made_up(leaf) {
                net["hide_name"] = json!(1);
            }
            let sign = types.get(leaf).copied().flatten();
            if sign == Some(true) {
                net["signed"] = json!(1);
            }
            if !is_made_up(leaf) {
                signs.declare(top_bit(&net["bits"]), sign);
            }
        }
        signs.read(module);
    }
    Ok(file.to_string())
}

/// A name that GHDL has made: `n12_o`, `n13_q`.
fn is_made_up(name: &str) -> bool {
    let digits = name.strip_prefix('n').and_then(|rest| rest.strip_suffix("_o").or(rest.strip_suffix("_q")));
    digits.is_some_and(|digits| !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit()))
}

/// For each line of the Verilog, from 0, the place in the VHDL of the statement that it is in, as `FILE:LINE.COLUMN`.
fn places(verilog: &str) -> Vec<Option<String>> {
    let mut current = None;
    let of_line = |line: &str| {
        let text = line.trim();
        let comment = text.strip_prefix("/* ").and_then(|rest| rest.strip_suffix("*/"));
        if let Some((rest, column)) = comment.and_then(|place| place.trim().rsplit_once(':')) {
            current = rest.rsplit_once(':').map(|(file, line)| format!("{file}:{line}.{column}"));
            return None;
        }
        let ends = text.split("//").next().is_some_and(|code| code.trim_end().ends_with(';'));
        if ends { current.take() } else { current.clone() }
    };
    verilog.lines().map(of_line).collect()
}

/// The attribute `src` with places of the VHDL where they are known.
fn moved(src: &str, places: &[Option<String>]) -> String {
    let one = |place: &str| {
        let range = place.strip_prefix(OF_GHDL)?.strip_prefix(':')?;
        let line: usize = range.split('.').next()?.parse().ok()?;
        let place = places.get(line.checked_sub(1)?)?.as_ref()?;
        let (_, from) = place.rsplit_once(':')?;
        Some(format!("{place}-{from}"))
    };
    src.split('|').map(|place| one(place).unwrap_or_else(|| place.to_owned())).collect::<Vec<_>>().join("|")
}

/// Whether names are declared with a type that has a sign; `None` where declarations differ, or of another type.
fn types(vhdl: &[String]) -> HashMap<String, Option<bool>> {
    let mut aliases: HashMap<String, Option<bool>> = HashMap::new();
    let mut found: HashMap<String, Option<bool>> = HashMap::new();
    for text in vhdl {
        let lines = text.lines().map(|line| line.split("--").next().unwrap_or(line).to_lowercase());
        let text = lines.collect::<Vec<_>>().join(" ");
        for part in text.split("subtype ").skip(1) {
            if let Some((name, of)) = part.split_once(" is ") {
                aliases.insert(name.trim().to_owned(), sign_of(of, &aliases));
            }
        }
        let ends = |c: char| matches!(c, ';' | '(' | ')');
        let mut rest = text.as_str();
        while let Some((before, after)) = rest.split_once(':') {
            let names = before.rsplit(ends).next().unwrap_or(before);
            let names = names.split_whitespace().collect::<Vec<_>>().join(" ");
            let sign = sign_of(after, &aliases);
            for name in names.split(',') {
                let name = name.trim().rsplit(' ').next().unwrap_or(name).to_owned();
                found
                    .entry(name)
                    .and_modify(|known| *known = known.filter(|known| Some(*known) == sign))
                    .or_insert(sign);
            }
            rest = after;
        }
    }
    found
}

/// Whether the type at the beginning of a text has a sign.
fn sign_of(text: &str, aliases: &HashMap<String, Option<bool>>) -> Option<bool> {
    let mut words =
        text.split(|c: char| !(c.is_alphanumeric() || c == '_' || c == '-')).filter(|word| !word.is_empty());
    let word = words.find(|word| !matches!(*word, "in" | "out" | "inout" | "buffer"))?;
    match word {
        "signed" | "sfixed" => Some(true),
        "unsigned" | "ufixed" | "natural" | "positive" => Some(false),
        "integer" => match (words.next(), words.next()) {
            (Some("range"), Some(low)) => Some(low.starts_with('-')),
            _ => Some(true),
        },
        alias => aliases.get(alias).copied().flatten(),
    }
}

/// The number of the highest net of a word.
fn top_bit(bits: &Value) -> Option<u64> {
    bits.as_array().and_then(|bits| bits.last()).and_then(Value::as_u64)
}

/// Highest bits of words that have a sign, and of those that are declared as something else.
#[derive(Default)]
struct Signs {
    signed: HashSet<u64>,
    others: HashSet<u64>,
    unsigned: HashSet<u64>,
}

/// Bits of the results of `integer`.
const INTEGER: usize = 32;

impl Signs {
    fn declare(&mut self, top: Option<u64>, sign: Option<bool>) {
        self.others.extend(top.filter(|_| sign != Some(true)));
        match sign {
            Some(true) => self.signed.extend(top),
            Some(false) => self.unsigned.extend(top),
            None => {}
        }
    }

    /// Marks the operands of arithmetic as signed where one of operands and result is. All have the same width, so that
    /// this changes how they are read, and not what they are.
    fn read(mut self, module: &mut Value) {
        let Some(cells) = module["cells"].as_object_mut() else { return };
        let unsigned = std::mem::take(&mut self.unsigned);
        self.signed.retain(|top| !unsigned.contains(top));
        close(&mut self.signed, &unsigned, cells);
        close(&mut self.others, &HashSet::new(), cells);
        for cell in cells.values_mut().filter(|cell| cell["type"].as_str().is_some_and(is_arithmetic)) {
            let pins = &cell["connections"];
            let used: Vec<&Value> = ["A", "B", "Y"].iter().filter_map(|pin| pins.get(*pin)).collect();
            let width = |bits: &Value| bits.as_array().map_or(0, Vec::len);
            let alike = used.iter().all(|bits| width(bits) == width(&pins["Y"]));
            let any = |tops: &HashSet<u64>| used.iter().filter_map(|bits| top_bit(bits)).any(|top| tops.contains(&top));
            // What no declared word takes part in is an `integer` in between.
            let integer = width(&pins["Y"]) == INTEGER && !any(&self.others);
            if alike && (any(&self.signed) || integer) {
                for flag in ["A_SIGNED", "B_SIGNED"] {
                    if let Some(flag) = cell["parameters"].get_mut(flag) {
                        *flag = json!("1");
                    }
                }
            }
        }
    }
}

/// Adds the words that have the type of one of these: the operands and the result of arithmetic have the same. What goes into
/// a typed word has its type; what comes of it may be a word of bits.
fn close(tops: &mut HashSet<u64>, never: &HashSet<u64>, cells: &serde_json::Map<String, Value>) {
    loop {
        let before = tops.len();
        for cell in cells.values() {
            let of =
                |pins: &[&str]| pins.iter().filter_map(|pin| top_bit(&cell["connections"][*pin])).collect::<Vec<_>>();
            let (from, to) = match cell["type"].as_str().unwrap_or_default() {
                kind if is_arithmetic(kind) => (of(&["A", "B", "Y"]), of(&["A", "B", "Y"])),
                "$mux" => (of(&["Y"]), of(&["A", "B"])),
                "$dff" | "$dffe" | "$adff" | "$adffe" | "$sdff" | "$sdffe" => (of(&["Q"]), of(&["D"])),
                _ => continue,
            };
            if from.iter().any(|top| tops.contains(top)) {
                tops.extend(to.into_iter().filter(|top| !never.contains(top)));
            }
        }
        if tops.len() == before {
            return;
        }
    }
}

fn is_arithmetic(kind: &str) -> bool {
    matches!(kind, "$add" | "$sub" | "$mul" | "$neg")
}

#[cfg(test)]
mod tests {
    use super::*;

    const VERILOG: &str = "module t\n  (input  clk,\n   input  [3:0] a);\n  reg [3:0] acc;\n  wire [3:0] n4_o;\n  reg [3:0] n5_q;\n  \
        /* src/t.vhd:9:10  */\n  always @*\n    acc = n5_q; // (isignal)\n  /* src/t.vhd:12:20  */\n  assign n4_o = acc + a;\n  \
        /* src/t.vhd:11:5  */\n  always @(posedge clk)\n    n5_q <= n4_o;\n  initial\n    n5_q <= 4'b0000;\nendmodule\n";

    #[test]
    fn a_statement_has_the_place_in_the_comment_before_it() {
        let places = places(VERILOG);
        let at = |line: usize| places[line - 1].as_deref();
        assert_eq!(
            [at(4), at(8), at(9), at(11)],
            [None, Some("src/t.vhd:9.10"), Some("src/t.vhd:9.10"), Some("src/t.vhd:12.20")]
        );
        assert_eq!([at(13), at(14), at(15), at(16)], [Some("src/t.vhd:11.5"), Some("src/t.vhd:11.5"), None, None]);
        assert_eq!(moved("written-by-ghdl.v:11.17-11.24", &places), "src/t.vhd:12.20-12.20");
        assert_eq!(
            moved("written-by-ghdl.v:4.13-4.16|u.v:1.1-1.2", &places),
            "written-by-ghdl.v:4.13-4.16|u.v:1.1-1.2"
        );
    }

    #[test]
    fn operators_of_signed_numbers_are_signed() {
        let cases = [
            ("  assign n1_o = $signed(a) >> 31'b100;", "  assign n1_o = $signed(a) >>> 31'b100;"),
            ("  assign n2_o = b >> 31'b100;", "  assign n2_o = b >> 31'b100;"),
            ("  assign n3_o = $signed(a) < $signed(b);", "  assign n3_o = $signed(a) < $signed(b);"),
            ("  assign n4_o = a / b; // sdiv", "  assign n4_o = $signed(a) / $signed(b);"),
            ("  assign n5_o = a % 4'b101; // srem", "  assign n5_o = $signed(a) % $signed(4'b101);"),
            ("  assign n6_o = a % b; // umod", "  assign n6_o = a % b; // umod"),
            ("  n7_o <= std_logic_vector(abs $signed(a));", "  assign n7_o = $signed(a) < 0 ? -a : a;"),
        ];
        for (line, expected) in cases {
            assert_eq!(with_signs(line), format!("{expected}\n"));
        }
    }

    #[test]
    fn declarations_say_which_names_have_a_sign() {
        let text = "entity t is port (clk, rst : in std_logic; X, y : in signed(7 downto 0); n : out unsigned(3 downto 0));\n\
            subtype word is signed(11 downto 0); -- z : signed\n signal acc, old : word := (others => '0');\n\
            signal level : integer range -100 to 100; signal up : integer range 0 to 9; variable v : integer;\n\
            signal both : signed(1 downto 0); signal other : bit; process (a) variable both : unsigned(1 downto 0);\n";
        let types = types(&[text.to_owned()]);
        let of = |name: &str| types.get(name).copied();
        for name in ["x", "y", "acc", "old", "level", "v"] {
            assert_eq!(of(name), Some(Some(true)), "{name}");
        }
        for name in ["n", "up"] {
            assert_eq!(of(name), Some(Some(false)), "{name}");
        }
        assert_eq!([of("clk"), of("both"), of("other"), of("z")], [Some(None), Some(None), Some(None), None]);
    }

    /// acc of 4 bits takes acc + a in each clock.
    fn of_type(declared: &str) -> Value {
        let sum = json!({ "type": "$add", "attributes": { "src": "written-by-ghdl.v:11.17-11.24" },
            "parameters": { "A_SIGNED": "0", "B_SIGNED": "0" },
            "connections": { "A": [10, 11, 12, 13], "B": [3, 4, 5, 6], "Y": [20, 21, 22, 23] } });
        let register = json!({ "type": "$dff", "attributes": {}, "parameters": {},
            "connections": { "CLK": [2], "D": [20, 21, 22, 23], "Q": [10, 11, 12, 13] } });
        let name = |bits: [u64; 4]| json!({ "hide_name": 0, "bits": bits, "attributes": {} });
        let names =
            json!({ "acc": name([10, 11, 12, 13]), "n5_q": name([10, 11, 12, 13]), "n4_o": name([20, 21, 22, 23]) });
        let text =
            json!({ "modules": { "t": { "cells": { "s": sum, "r": register }, "netnames": names } } }).to_string();
        let vhdl = format!("signal acc : {declared}(3 downto 0);");
        serde_json::from_str::<Value>(&restored(&text, VERILOG, &[vhdl]).unwrap()).unwrap()["modules"]["t"].take()
    }

    #[test]
    fn a_sum_is_read_as_the_register_is_declared_that_it_feeds() {
        let signed = of_type("signed");
        assert_eq!(signed["cells"]["s"]["parameters"], json!({ "A_SIGNED": "1", "B_SIGNED": "1" }));
        assert_eq!(signed["cells"]["s"]["attributes"]["src"], "src/t.vhd:12.20-12.20");
        assert_eq!(signed["netnames"]["acc"]["signed"], 1);
        let hidden = ["acc", "n5_q", "n4_o"].map(|name| signed["netnames"][name]["hide_name"].clone());
        assert_eq!(hidden, [json!(0), json!(1), json!(1)]);
        for other in ["unsigned", "std_logic_vector"] {
            let module = of_type(other);
            assert_eq!(module["cells"]["s"]["parameters"], json!({ "A_SIGNED": "0", "B_SIGNED": "0" }), "{other}");
            assert_eq!(module["netnames"]["acc"].get("signed"), None);
        }
    }
}
