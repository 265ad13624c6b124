//! The file of a page: its programs, and the runs packed into it.

use std::io::{self, Write};

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use miniz_oxide::deflate::compress_to_vec_zlib;
use serde_json::{Value, json};
use sha2::{Digest as _, Sha256};

use crate::report::plot::escaped;

const SKELETON: &str = include_str!("page.html");
const STYLE: &str = include_str!("page.css");
/// The programs of the page; together they are one module.
const PROGRAMS: [&str; 12] = [
    include_str!("data.js"),
    include_str!("numbers.js"),
    include_str!("words.js"),
    include_str!("canvas.js"),
    include_str!("path.js"),
    include_str!("wave.js"),
    include_str!("draw.js"),
    include_str!("table.js"),
    include_str!("panels.js"),
    include_str!("diagram.js"),
    include_str!("cursor.js"),
    include_str!("main.js"),
];
/// How hard the runs are packed, of 10.
const LEVEL: u8 = 6;

/// A run in a page that is being put together: its streams.
pub(crate) struct Run {
    name: String,
    /// Streams one after another, and where each ends.
    streams: Vec<u8>,
    ends: Vec<usize>,
}

/// A run as a page holds it.
pub(crate) struct Packed {
    name: String,
    text: String,
}

/// Several runs of one curve, a row of a table each.
pub(crate) struct Comparison {
    /// What is compared.
    pub(crate) title: String,
    /// Names of the columns.
    pub(crate) heading: Vec<String>,
    /// The row of each run.
    pub(crate) rows: Vec<Vec<String>>,
}

impl Run {
    /// Without data.
    pub(super) fn new(name: &str) -> Run {
        Run { name: name.to_owned(), streams: Vec::new(), ends: Vec::new() }
    }

    /// Takes a stream; its number.
    pub(super) fn stream(&mut self, bytes: &[u8]) -> usize {
        self.streams.extend_from_slice(bytes);
        self.ends.push(self.streams.len());
        self.ends.len() - 1
    }

    /// As text of a page, with what is known of it: four bytes that give the length of the description, this as JSON, then
    /// the streams; deflated, in base 64.
    pub(super) fn packed(self, mut meta: Value) -> Packed {
        meta["ends"] = json!(self.ends);
        let meta = meta.to_string();
        // A description has at most some megabytes.
        let length = u32::try_from(meta.len()).unwrap_or(u32::MAX).to_le_bytes();
        let mut all = Vec::with_capacity(4 + meta.len() + self.streams.len());
        all.extend_from_slice(&length);
        all.extend_from_slice(meta.as_bytes());
        all.extend_from_slice(&self.streams);
        Packed { name: self.name, text: STANDARD.encode(compress_to_vec_zlib(&all, LEVEL)) }
    }
}

/// What a content security policy calls an inline script or style.
fn hash(text: &str) -> String {
    format!("'sha256-{}'", STANDARD.encode(Sha256::digest(text.as_bytes())))
}

/// Text between the tags of a script that is data.
fn as_data(value: &Value) -> String {
    value.to_string().replace('<', "\\u003c")
}

/// Writes a page.
///
/// # Errors
/// The output cannot be written.
pub(crate) fn write(out: &mut impl Write, title: &str, runs: &[Packed], of: Option<&Comparison>) -> io::Result<()> {
    let script = PROGRAMS.concat();
    let policy = format!(
        "default-src 'none'; script-src {}; style-src {}; base-uri 'none'; form-action 'none'",
        hash(&script),
        hash(STYLE)
    );
    let (head, rest) = SKELETON.split_once("<!--data-->").unwrap_or((SKELETON, ""));
    let head = head.replace("{{policy}}", &policy).replace("{{title}}", &escaped(title));
    out.write_all(head.replace("{{style}}", STYLE).as_bytes())?;
    let comparison = of.map(|of| json!({ "title": of.title, "heading": of.heading, "rows": of.rows }));
    writeln!(out, "<script type=\"application/json\" id=\"comparison\">{}</script>", as_data(&json!(comparison)))?;
    for run in runs {
        let name = escaped(&run.name).replace('"', "&quot;");
        writeln!(out, "<script type=\"text/plain\" class=\"run\" data-run=\"{name}\">{}</script>", run.text)?;
    }
    out.write_all(rest.replace("{{script}}", &script).as_bytes())
}
