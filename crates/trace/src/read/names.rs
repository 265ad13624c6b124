//! From the declarations of a file to its named signals.

use super::limits::{self, MAX_DEPTH, MAX_PATH};
use super::store::Changes;
use super::value::Value;
use super::{Signal, ValueKind};
use std::collections::{HashMap, HashSet, VecDeque};

/// The variables declared so far, and the scope that is open.
pub(super) struct Names {
    file: u64,
    prefix: String,
    /// The length of the prefix at the beginning of each open scope.
    open: Vec<usize>,
    /// Counts scopes that begin or end: variables with one number follow each other in one scope.
    place: usize,
    vars: Vec<Declared>,
    bytes: u64,
}

struct Declared {
    path: String,
    index: Option<(i64, i64)>,
    place: usize,
    signed: bool,
    stored: usize,
}

/// What a declaration says of its variable.
pub(super) struct Var<'a> {
    pub(super) name: &'a str,
    pub(super) kind: ValueKind,
    pub(super) width: u32,
    /// Its place among the stored changes.
    pub(super) stored: usize,
}

impl Names {
    /// None yet, of a file with this number of bytes.
    pub(super) fn new(file: u64) -> Self {
        Self { file, prefix: String::new(), open: Vec::new(), place: 0, vars: Vec::new(), bytes: 0 }
    }

    /// A scope begins; inside, why it cannot.
    pub(super) fn scope(&mut self, name: &str) -> Result<(), String> {
        if self.open.len() == MAX_DEPTH {
            return Err(format!("more than {MAX_DEPTH} scopes within one another cannot be read"));
        }
        self.open.push(self.prefix.len());
        self.prefix.push_str(name);
        self.prefix.push('.');
        self.place += 1;
        self.room(0)
    }

    /// The innermost scope ends.
    pub(super) fn upscope(&mut self) -> Result<(), String> {
        let before = self.open.pop().ok_or("$upscope where no scope is open; take it out")?;
        self.prefix.truncate(before);
        self.place += 1;
        Ok(())
    }

    fn room(&self, name: usize) -> Result<(), String> {
        if self.prefix.len() + name > MAX_PATH {
            return Err(format!("a path of more than {MAX_PATH} bytes, scopes and name, cannot be read"));
        }
        Ok(())
    }

    /// The path of a variable in the scope that is open, as a message quotes it.
    pub(super) fn quoted(&self, name: &str) -> String {
        format!("{}{name}", self.prefix)
    }

    /// The path of the first variable with these changes.
    pub(super) fn path_of(&self, stored: usize) -> &str {
        self.vars.iter().find(|var| var.stored == stored).map_or("", |var| &var.path)
    }

    /// A variable of the scope that is open.
    pub(super) fn var(&mut self, var: &Var<'_>) -> Result<(), String> {
        let (name, index) = split(var.name, var.width, matches!(var.kind, ValueKind::Unsigned | ValueKind::Signed))?;
        self.room(name.len())?;
        let path = format!("{}{name}", self.prefix);
        self.bytes += path.len() as u64 + limits::SIGNAL;
        let limit = limits::signals(self.file);
        if self.bytes > limit {
            let limit = limits::mebibytes(limit);
            return Err(format!(
                "the signals and their paths take more than {limit}, the limit for a file of its size"
            ));
        }
        let signed = var.kind == ValueKind::Signed;
        self.vars.push(Declared { path, index, place: self.place, signed, stored: var.stored });
        Ok(())
    }

    /// The signals, no two of one path. A vector whose bits are declared one by one becomes whole; its changes are
    /// added to `stored`.
    pub(super) fn signals(self, stored: &mut Vec<Changes>) -> Result<Vec<Signal>, String> {
        let mut unique = Unique::default();
        let mut signals = Vec::with_capacity(self.vars.len());
        let mut room = limits::inflated(self.file);
        let mut vars = self.vars.into_iter().peekable();
        while let Some(var) = vars.next() {
            let mut parts = Parts::new(&var);
            while let Some(next) = vars.next_if(|next| parts.takes(&var, next, stored)) {
                parts.add(&next);
            }
            let mut place = var.stored;
            if parts.order.len() > 1 {
                let whole = parts.compose(&var.path, stored, &mut room)?;
                place = stored.len();
                stored.push(whole);
            }
            let (kind, width) = stored.get(place).map_or((ValueKind::Event, 0), Changes::kind);
            let kind = if kind == ValueKind::Unsigned && var.signed { ValueKind::Signed } else { kind };
            let path = unique.path(var.path, Some(parts.range).filter(|_| var.index.is_some()));
            signals.push(Signal { path, width, kind, stored: place });
        }
        Ok(signals)
    }
}

/// The variables that make one vector, the most significant first.
struct Parts {
    order: VecDeque<usize>,
    range: (i64, i64),
}

impl Parts {
    fn new(first: &Declared) -> Self {
        Self { order: VecDeque::from([first.stored]), range: first.index.unwrap_or_default() }
    }

    /// Whether the variable continues the vector that began with `first`, as some simulators declare vectors.
    fn takes(&self, first: &Declared, next: &Declared, stored: &[Changes]) -> bool {
        let bits =
            |var: &Declared| stored.get(var.stored).is_some_and(|changes| changes.kind().0 == ValueKind::Unsigned);
        let Some((msb, lsb)) = next.index.filter(|_| first.index.is_some()) else { return false };
        let adjacent = lsb == self.range.0.saturating_add(1) || self.range.1 == msb.saturating_add(1);
        let falling = msb >= lsb && self.range.0 >= self.range.1;
        first.place == next.place && first.path == next.path && adjacent && falling && bits(first) && bits(next)
    }

    fn add(&mut self, next: &Declared) {
        let (msb, lsb) = next.index.unwrap_or_default();
        if lsb == self.range.0.saturating_add(1) {
            self.order.push_front(next.stored);
            self.range.0 = msb;
        } else {
            self.order.push_back(next.stored);
            self.range.1 = lsb;
        }
    }

    fn compose(&self, path: &str, stored: &[Changes], room: &mut u64) -> Result<Changes, String> {
        let parts: Vec<&Changes> = self.order.iter().filter_map(|part| stored.get(*part)).collect();
        let mut at = Vec::new();
        let mut width = 0;
        for part in &parts {
            at.extend(part.times().iter().enumerate().map(|(change, time)| (*time, width, *part, change)));
            width += part.kind().1 as usize;
        }
        at.sort_by_key(|(time, ..)| *time);
        let cost = (at.len() as u64).saturating_mul(width as u64 + 8);
        *room = room.checked_sub(cost).ok_or_else(|| {
            format!("`{path}` is declared bit by bit, {width} bits, and together its changes take too much memory")
        })?;
        let mut whole = Changes::new(ValueKind::Unsigned, u32::try_from(width).unwrap_or(u32::MAX));
        let mut digits = vec![b'x'; width];
        for (number, (time, first, part, change)) in at.iter().enumerate() {
            if let Value::Bits(bits) = part.value(*change, false) {
                digits.iter_mut().skip(*first).zip(bits.digits()).for_each(|(digit, new)| *digit = new as u8);
            }
            if at.get(number + 1).is_none_or(|next| next.0 != *time) {
                whole.bits(*time, &digits).map_err(|_| format!("`{path}` is declared bit by bit in no order"))?;
            }
        }
        Ok(whole)
    }
}

/// Paths already given.
#[derive(Default)]
struct Unique {
    taken: HashSet<String>,
    next: HashMap<String, u64>,
}

impl Unique {
    /// The path, or, if it is another signal's, the path with its range, then with a number.
    fn path(&mut self, path: String, range: Option<(i64, i64)>) -> String {
        let mut name = path;
        if self.taken.contains(&name) {
            if let Some((msb, lsb)) = range {
                name = format!("{name}[{msb}:{lsb}]");
            }
            if self.taken.contains(&name) {
                let number = self.next.entry(name.clone()).or_insert(2);
                while self.taken.contains(&format!("{name}#{number}")) {
                    *number += 1;
                }
                name = format!("{name}#{number}");
            }
        }
        self.taken.insert(name.clone());
        name
    }
}

/// An index after a name.
enum Index {
    Range(i64, i64),
    Element,
}

impl Index {
    fn span(&self) -> Option<u64> {
        match self {
            Index::Range(msb, lsb) => msb.abs_diff(*lsb).checked_add(1),
            Index::Element => None,
        }
    }
}

/// Takes a name apart: without its bit range, and the range. An index that is not a bit range, but picks an element of
/// an array, stays as a part of the path.
fn split(raw: &str, width: u32, bits: bool) -> Result<(String, Option<(i64, i64)>), String> {
    let raw = raw.trim_end();
    // All of an escaped name up to its blank is its name.
    let floor = if raw.starts_with('\\') { raw.find(' ').unwrap_or(raw.len()) } else { 0 };
    let mut indices: Vec<(usize, Index, i64)> = Vec::new();
    let mut end = raw.len();
    while raw[..end].ends_with(']') {
        let Some(open) = raw[floor..end].rfind('[').map(|open| open + floor).filter(|open| *open > 0) else { break };
        let inside = &raw[open + 1..end - 1];
        let whole = |text: &str| text.trim().parse::<i64>().ok();
        let (index, first) = match inside.split_once(':').map(|(msb, lsb)| (whole(msb), whole(lsb))) {
            Some((Some(msb), Some(lsb))) => (Index::Range(msb, lsb), msb),
            None if let Some(element) = whole(inside) => (Index::Element, element),
            _ => break,
        };
        end = raw[..open].trim_end().len();
        indices.push((open, index, first));
    }
    let name = |last: usize| {
        let mut name = raw[..end].to_owned();
        for (place, (open, ..)) in indices.iter().enumerate().skip(last).rev() {
            let close = place.checked_sub(1).and_then(|next| indices.get(next)).map_or(raw.len(), |(next, ..)| *next);
            name.push('.');
            name.push_str(raw[*open..close].trim_end());
        }
        name
    };
    let width = u64::from(width);
    Ok(match indices.first() {
        Some((_, Index::Range(msb, lsb), _)) if msb.abs_diff(*lsb).checked_add(1) == Some(width) => {
            (name(1), Some((*msb, *lsb)))
        }
        Some((_, Index::Range(msb, lsb), _)) if bits && width > 0 => {
            // Several packed dimensions: together they have the declared width.
            let mut product = 1u64;
            let spans = indices.iter().map_while(|(_, index, _)| index.span());
            let full = spans.enumerate().find(|(_, span)| {
                product = product.saturating_mul(*span);
                product == width
            });
            let Some((last, _)) = full else {
                return Err(format!(
                    "the range [{msb}:{lsb}] is not {width} bit{} wide, as declared: correct the range or the width",
                    if width == 1 { "" } else { "s" }
                ));
            };
            (name(last + 1), None)
        }
        Some((_, Index::Element, bit)) if bits && width == 1 => (name(1), Some((*bit, *bit))),
        Some(_) if bits && width == 0 => (name(1), None),
        _ => (name(0), None),
    })
}

#[cfg(test)]
mod tests {
    use super::split;

    #[test]
    fn a_range_of_the_declared_width_is_taken_off_and_another_is_refused() {
        for (raw, width, name, range) in [
            ("q", 4, "q", None),
            ("q [3:0]", 4, "q", Some((3, 0))),
            ("q[0:3]", 4, "q", Some((0, 3))),
            ("q [-1:-4]", 4, "q", Some((-1, -4))),
            ("q [5]", 1, "q", Some((5, 5))),
            ("mem[3] [7:0]", 8, "mem.[3]", Some((7, 0))),
            ("mem [2][3]", 8, "mem.[2].[3]", None),
            ("packed [3:0] [7:0]", 32, "packed", None),
            ("mem[1][3:0][7:0]", 32, "mem.[1]", None),
            ("\\mem[0] [7:0]", 8, "\\mem[0]", Some((7, 0))),
            ("\\odd[9:0]", 4, "\\odd[9:0]", None),
            ("[3]", 8, "[3]", None),
            ("a[3].b [1:0]", 2, "a[3].b", Some((1, 0))),
            ("none [-1:0]", 0, "none", None),
        ] {
            assert_eq!(split(raw, width, true), Ok((name.into(), range)), "{raw}");
        }
        for (raw, width) in [("q [7:0]", 4), ("q [3:0] [1:0]", 4), ("q [9223372036854775807:-9223372036854775807]", 1)]
        {
            assert!(split(raw, width, true).is_err(), "{raw}");
        }
        assert_eq!(split("r [63:0]", 1, false), Ok(("r.[63:0]".into(), None)));
    }
}
