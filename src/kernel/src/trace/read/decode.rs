//! From the bytes of a file to a [`Wave`], through the crate `wellen`.

use super::scan::{self, Format};
use super::{Clock, ClockError, Kind, Signal, Timescale, Wave, WaveError};
use std::any::Any;
use std::cell::Cell;
use std::collections::{HashMap, HashSet};
use std::io::{BufRead, Seek};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Once;
use wellen::{Hierarchy, LoadOptions, SignalEncoding, SignalRef, VarType, WellenError, viewers};

/// The widest vector accepted, in bits: `wellen` expands every value to the declared width.
pub(super) const MAX_WIDTH: u32 = 1 << 20;

/// Decodes a file whose format is known.
pub(super) fn wave<R>(mut input: R, format: Format, name: String) -> Result<Wave, WaveError>
where
    R: BufRead + Seek + Send + Sync + 'static,
{
    match format {
        Format::Vcd => scan::vcd(&mut input, &name)?,
        Format::Fst => scan::fst(&mut input, &name)?,
    }
    input.rewind().map_err(|source| WaveError::Io { name: name.clone(), source })?;
    let mut wave = match quietly(|| decode(input, &name)) {
        Ok(decoded) => decoded?,
        Err(reason) => return Err(malformed(&name, &reason)),
    };
    wave.clock = Clock::found(&wave);
    Ok(wave)
}

fn decode<R>(input: R, name: &str) -> Result<Wave, WaveError>
where
    R: BufRead + Seek + Send + Sync + 'static,
{
    let failed = |error| match error {
        WellenError::FailedToLoad(_, reason) => malformed(name, &reason),
        other => malformed(name, &other.to_string()),
    };
    let options = LoadOptions { multi_thread: false, remove_scopes_with_empty_name: false };
    let header = viewers::read_header(input, &options).map_err(failed)?;
    let hierarchy = header.hierarchy;
    let (signals, refs) = signals(&hierarchy);
    if let Some(wide) = signals.iter().find(|signal| signal.width > MAX_WIDTH) {
        return Err(WaveError::TooWide { name: name.into(), path: wide.path.clone(), width: wide.width });
    }
    let mut body = viewers::read_body(header.body, &hierarchy, None).map_err(failed)?;
    let mut stored = body.source.load_signals(&refs, &hierarchy, false);
    let place: HashMap<SignalRef, usize> = refs.iter().enumerate().map(|(place, id)| (*id, place)).collect();
    stored.iter().for_each(touch);
    stored.sort_by_key(|signal| place.get(&signal.signal_ref()).copied());
    let timescale = hierarchy.timescale().and_then(|scale| {
        Some(Timescale { factor: scale.factor, exponent: scale.unit.to_exponent()? }).filter(|scale| scale.factor > 0)
    });
    let clock = Err(ClockError::None { name: name.into() });
    Ok(Wave { name: name.into(), timescale, times: body.time_table, signals, stored, clock })
}

/// Looks at every value once: a file whose declarations contradict each other panics here, where that is caught.
fn touch(signal: &wellen::Signal) {
    for (_, value) in signal.iter_changes() {
        if let wellen::SignalValueRef::BitVec(bits) = value
            && bits.be_bytes().is_none()
        {
            bits.iter_lsb_to_msb().map(|bit| bit.as_ascii()).for_each(drop);
        }
    }
}

fn malformed(name: &str, reason: &str) -> WaveError {
    // Reasons quote the file, which may hold anything.
    let reason = reason.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    WaveError::Malformed { name: name.into(), reason }
}

/// The named signals, and what they refer to, each once, in the order of `Signal::stored`.
fn signals(hierarchy: &Hierarchy) -> (Vec<Signal>, Vec<SignalRef>) {
    let mut places: HashMap<SignalRef, usize> = HashMap::new();
    let mut refs = Vec::new();
    let mut taken: HashSet<String> = HashSet::new();
    let mut signals = Vec::new();
    for var in hierarchy.all_vars().map(|var| &hierarchy[var]) {
        let id = var.signal_ref();
        let (mut kind, width) = match var.signal_encoding(hierarchy) {
            SignalEncoding::String => (Kind::Text, 0),
            SignalEncoding::Real => (Kind::Real, 64),
            SignalEncoding::BitVector(0) => (Kind::Event, 0),
            SignalEncoding::BitVector(width) => (Kind::Unsigned, width),
        };
        let signed = matches!(
            var.var_type(),
            VarType::Integer | VarType::Int | VarType::ShortInt | VarType::LongInt | VarType::Byte
        );
        if kind == Kind::Unsigned && signed {
            kind = Kind::Signed;
        }
        let stored = *places.entry(id).or_insert_with(|| {
            refs.push(id);
            refs.len() - 1
        });
        let mut path = var.full_name(hierarchy);
        if taken.contains(&path) {
            // The same name again: another bit range of it, or a second declaration.
            if let Some(index) = var.index() {
                path = format!("{path}[{}:{}]", index.msb(), index.lsb());
            }
            let name = path.clone();
            let mut number = 2;
            while taken.contains(&path) {
                path = format!("{name}#{number}");
                number += 1;
            }
        }
        taken.insert(path.clone());
        signals.push(Signal { path, width, kind, stored });
    }
    (signals, refs)
}

/// Does work that panics on broken input, and gives the panic's message instead.
///
/// The panic hook is asked not to print panics of this thread meanwhile; every other panic goes to the hook that was
/// there before. All of the decoding stays on this thread.
fn quietly<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    thread_local! {
        static QUIET: Cell<bool> = const { Cell::new(false) };
    }
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let before = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            if !QUIET.get() {
                before(panic);
            }
        }));
    });
    QUIET.set(true);
    let result = catch_unwind(AssertUnwindSafe(work));
    QUIET.set(false);
    result.map_err(|panic: Box<dyn Any + Send>| {
        let text = panic.downcast_ref::<String>().map(String::as_str);
        text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("unknown reason").to_string()
    })
}
