//! The words of comments and names.

use super::tidy::sources;

/// Sources whose doc comments are the help of the command line, which is part of the interface.
const HELP: [&str; 4] = ["src/cli.rs", "src/cli", "src/waves.rs", "src/commands/diff.rs"];

/// Words that no engineer of this field writes, each with what it should be.
const WORDS: [(&str, &str); 7] = [
    ("behind", "after, driven by"),
    ("beside", "next to, in addition to"),
    ("told", "reported, given"),
    ("tells", "says, gives, reports"),
    ("whoever", "the reader, the caller"),
    ("stands", "is"),
    ("stood", "was"),
];

/// The same of phrases.
const PHRASES: [(&str, &str); 6] = [
    ("so many", "this many"),
    ("came to a stand", "stalled"),
    ("goes on", "continues"),
    ("go on", "continue"),
    ("such one", "such sample, such row, ..."),
    ("is no", "is not a"),
];

/// The text of a source file without what its string literals hold.
fn without_strings(text: &str) -> String {
    let mut kept = String::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let skipped = if rest.starts_with("//") {
            let line = rest.find('\n').unwrap_or(rest.len());
            kept.push_str(&rest[..line]);
            line
        } else if let Some(raw) = rest.strip_prefix("r#\"") {
            rest.len() - raw.len() + raw.find("\"#").map_or(raw.len(), |end| end + 2)
        } else if ["'\"'", "'\\\"'", "b'\"'"].iter().any(|quote| rest.starts_with(quote)) {
            rest[1..].find('\'').map_or(rest.len(), |end| end + 2)
        } else if first == '"' {
            let mut escaped = false;
            let end = rest[1..].find(|c: char| {
                let ends = c == '"' && !escaped;
                escaped = c == '\\' && !escaped;
                ends
            });
            end.map_or(rest.len(), |end| end + 2)
        } else {
            kept.push(first);
            first.len_utf8()
        };
        kept.extend(rest[..skipped].chars().filter(|&c| c == '\n' && first == '"'));
        rest = &rest[skipped..];
    }
    kept
}

/// The line with a blank inside a name where its next word begins.
fn separated(line: &str) -> String {
    let mut last = ' ';
    let mut text = String::new();
    for c in line.chars() {
        if last.is_lowercase() && c.is_uppercase() {
            text.push(' ');
        }
        text.push(c);
        last = c;
    }
    text
}

/// What a line says in a word or a phrase of the lists.
fn oddity(line: &str) -> Option<(&'static str, &'static str)> {
    let (code, comment) = line.split_once("//").unwrap_or((line, ""));
    let lower = separated(line).to_lowercase();
    let words: Vec<&str> = lower.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
    let is_odd = |index: usize| match words[index] {
        "stands" | "stood" => words.get(index + 1) != Some(&"for"),
        _ => true,
    };
    let word = WORDS.iter().find(|(odd, _)| (0..words.len()).any(|index| words[index] == *odd && is_odd(index)));
    let phrase = || {
        let comment = comment.to_lowercase();
        let words: Vec<&str> = comment.split_whitespace().collect();
        PHRASES.iter().find(|(odd, _)| {
            let odd: Vec<&str> = odd.split(' ').collect();
            words.windows(odd.len()).enumerate().any(|(at, found)| {
                let good = odd == ["is", "no"]
                    && (at.checked_sub(1).is_some_and(|before| words[before] == "there")
                        || words.get(at + 2).is_some_and(|next| ["longer", "more", "less", "error"].contains(next)));
                found == odd && !good
            })
        })
    };
    let code = separated(code).to_lowercase();
    let has_route = || code.split(|c: char| !c.is_ascii_alphabetic()).any(|word| ["way", "ways"].contains(&word));
    word.or_else(phrase).copied().or_else(|| has_route().then_some(("way", "path, route, method, direction")))
}

#[test]
fn comments_and_names_are_in_the_words_of_the_field() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut found = Vec::new();
    for (path, text) in sources() {
        let has_help = HELP.iter().any(|folder| path.starts_with(root.join(folder)));
        for (number, line) in without_strings(&text).lines().enumerate() {
            let is_help = has_help && line.trim_start().starts_with("///");
            if let Some((odd, better)) = oddity(line).filter(|_| !is_help) {
                found.push(format!("{}:{}: {odd:?}, better: {better}: {line}", path.display(), number + 1));
            }
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn oddity_names_the_words_and_passes_the_names_that_look_like_them() {
    for line in [
        "let way = 1;",
        "fn edge_behind() {}",
        "// It is no number.",
        "/// Told of it.",
        "x // so many bits",
        "struct PulseWay;",
    ] {
        assert!(oddity(line).is_some(), "{line}");
    }
    for line in ["// There is no net.", "let always = away;", "// It is no longer one.", "// A stands for b."] {
        assert_eq!(oddity(line), None, "{line}");
    }
    assert_eq!(without_strings("a(\"told \\\" x\", '\"') // \"b\"\n\"c\nd\"e"), "a(, ) // \"b\"\n\ne");
}
