//! Globs that select signals by name.

use crate::guard::guarded;
use globset::Glob;
pub use globset::GlobMatcher;

/// The longest glob, in bytes, and the most braces within one another: longer and deeper ones, which no name needs,
/// take the crate's memory and stack.
const LONGEST: usize = 1000;
const DEEPEST: usize = 8;

/// Compiles a glob.
///
/// # Errors
/// Why the text is not one.
pub fn glob(pattern: &str) -> Result<GlobMatcher, String> {
    if pattern.len() > LONGEST {
        return Err(format!("it has {} bytes; at most {LONGEST} are read", pattern.len()));
    }
    let mut depth = 0usize;
    for brace in pattern.chars() {
        match brace {
            '{' => depth += 1,
            '}' => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth > DEEPEST {
            return Err(format!("more than {DEEPEST} braces within one another are not read"));
        }
    }
    let compile = || match Glob::new(pattern) {
        Ok(glob) => Ok(glob.compile_matcher()),
        Err(error) => Err(error.kind().to_string()),
    };
    guarded(compile).unwrap_or_else(|_| Err("its alternatives cannot be read".to_owned()))
}

/// A glob fits the leaf name, the dotted path, or the path without the design's name.
#[must_use]
pub fn fits(glob: &GlobMatcher, path: &str) -> bool {
    let leaf = path.rsplit('.').next().unwrap_or(path);
    let inner = path.split_once('.').map_or(path, |(_, inner)| inner);
    [leaf, path, inner].iter().any(|text| glob.is_match(text))
}

#[cfg(test)]
mod tests {
    use super::glob;

    #[test]
    fn what_is_no_glob_is_refused_and_never_panics() {
        assert!(glob("*.{x,y}[0-3]").is_ok_and(|glob| glob.is_match("m.x2") && !glob.is_match("m.x4")));
        for pattern in ["[z", "{a", "a}", "[z-a]", "{".repeat(9).as_str(), "{".repeat(5000).as_str(), &"a".repeat(1001)]
        {
            assert!(glob(pattern).is_err(), "{pattern}");
        }
        // Every short pattern of the characters that mean something.
        let characters = ['{', '}', '[', ']', ',', '*', '?', '\\', '!', '-', 'a', '/'];
        for number in 0..characters.len().pow(5) {
            let digit = |place: u32| characters[number / characters.len().pow(place) % characters.len()];
            let _ = glob(&(0..5).map(digit).collect::<String>());
        }
    }
}
