//! Native code and the call into it: the one file with `unsafe`.
//!
//! What makes it sound: the code reads and writes only the `state` words, the row words and the words of memories that its
//! plan names, all of which `call` checks the length of before it enters; an address outside of a memory reads the word
//! after it and writes nothing.
#![allow(unsafe_code)]

#[cfg(target_arch = "x86_64")]
use std::sync::Mutex;

use cranelift_codegen::ir::{AbiParam, Block, types};
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use cranelift_jit::{JITBuilder, JITModule};
use cranelift_module::{Linkage, Module, default_libcall_names};

use super::branching;
use super::codegen::{self, Plan};
use super::digesting;
use super::layout::Layout;
use super::passing;
use crate::digest::Wanted;
#[cfg(target_arch = "x86_64")]
use crate::lanes::{Compiled, Lane};

/// Values that an offset of 31 bits reaches.
const FARTHEST: usize = 1 << 28;

/// Bytes that code may take of the stack: about three a cell of a large machine.
const MOST_FRAME: u32 = 1 << 20;

/// The compiled loop: state, rows, clocks, memories → samples recorded, or clocks done where samples are passed over.
type Loop = unsafe extern "C" fn(*mut u64, *mut u64, u64, *mut u64) -> u64;

/// The compiled loop of a digest: state, narrow and wide records, words of trains, memories → 1, or 0 where it was
/// abandoned.
type DigestLoop = unsafe extern "C" fn(*mut u64, *mut u32, *mut i64, *mut u64, *mut u64) -> u64;

/// A compiled plan.
pub(super) struct Native {
    _memory: Code,
    code: Loop,
    state_words: usize,
    memory_words: usize,
    columns: usize,
    stride: usize,
    resting: Vec<usize>,
    phases: u64,
    /// Samples are passed over: the word of the state that holds the room for rows.
    room: Option<usize>,
}

impl Native {
    /// Compiles a plan; `None` where this machine has no code generator, or rows or memories are too large for one.
    pub(super) fn compile(plan: &Plan<'_>) -> Option<Native> {
        let passes = !plan.running.is_empty();
        // After the columns of sparse rows come their clocks.
        let values = (plan.columns.len() + usize::from(passes)).checked_mul(plan.stride)?;
        let memory_words = plan.memory_words();
        if values.max(memory_words) > FARTHEST {
            return None;
        }
        if plan.branches.is_some() && cfg!(target_endian = "big") {
            // Parts of words are stored at their first byte.
            return None;
        }
        let resting = plan.resting();
        let words = plan.registers.len() + plan.inputs.len();
        let effort = match plan.branches {
            None => Effort::Loop,
            Some(branches) if branches.lasting => Effort::Lasting,
            Some(_) => Effort::Fast,
        };
        let (module, address, state_words) = compiled(4, effort, |f, entry| {
            if plan.branches.is_some() {
                return branching::generate(plan, &resting, f, entry);
            }
            if passes {
                passing::generate(plan, &resting, f, entry);
                return Some(words + passing::words(plan));
            }
            codegen::generate(plan, &resting, f, entry);
            Some(words + 1)
        })?;
        // SAFETY: `address` is the start of a function just finalised, whose signature is that of `Loop` in the
        // platform's C calling convention, the default of the module.
        let code = unsafe { std::mem::transmute::<*const u8, Loop>(address) };
        Some(Native {
            _memory: module,
            code,
            state_words,
            memory_words,
            columns: plan.columns.len() + usize::from(passes),
            stride: plan.stride,
            resting,
            phases: plan.phases.len() as u64,
            room: passes.then_some(words + passing::ROOM),
        })
    }

    /// Words of the state that the code touches.
    pub(super) fn state_words(&self) -> usize {
        self.state_words
    }

    /// Number of phases: a call needs at least as many clocks.
    pub(super) fn phases(&self) -> u64 {
        self.phases
    }

    /// Columns, by index, that the code does not store: they stay as they are.
    pub(super) fn resting(&self) -> &[usize] {
        &self.resting
    }

    /// Rows from one column to the next, for which the code was made.
    pub(super) fn stride(&self) -> usize {
        self.stride
    }

    /// Runs up to `clocks` clocks, recording a row of each into `rows` from row `first` on; gives the number recorded.
    /// Where samples are passed over, as many rows as the state says, and the number of clocks.
    ///
    /// # Panics
    /// If `state`, `rows` or `memories` is too short, or `clocks` less than the number of phases.
    pub(super) fn call(
        &self,
        state: &mut [u64],
        rows: &mut [u64],
        first: usize,
        clocks: u64,
        memories: &mut [u64],
    ) -> u64 {
        assert!(memories.len() >= self.memory_words, "{} words of memories", memories.len());
        assert!(state.len() >= self.state_words, "state of {} words", state.len());
        assert!(self.phases <= clocks && i64::try_from(clocks).is_ok(), "{clocks} clocks");
        if self.columns > 0 {
            let room = self.stride.saturating_sub(first) as u64;
            let most = self.room.map_or(clocks, |word| state[word]);
            assert!((1..=room).contains(&most), "{most} rows, room for {room}");
            assert!(rows.len() >= self.columns * self.stride, "{} values", rows.len());
        }
        // SAFETY: the code touches `state_words` words of `state`, and in each of `columns` columns of `stride` values
        // at most `clocks` values after `first`, or as many as its word of the room says, all of which the assertions
        // have checked, and the words of `memories` that the plan names; it calls nothing and keeps no pointer. The module that holds it lives.
        unsafe { (self.code)(state.as_mut_ptr(), rows[first..].as_mut_ptr(), clocks, memories.as_mut_ptr()) }
    }
}

/// What is done for good code.
#[derive(Clone, Copy)]
enum Effort {
    /// All: a loop of few clocks.
    Loop,
    /// Registers are given with care: large code that will run for long.
    Lasting,
    /// As little as can be, in a time that grows as the code does.
    Fast,
}

/// A module with one function of this many words that returns a word, its address, and what `generate` gives, which has the
/// builder in the entry block.
fn compiled<T>(
    words: usize,
    effort: Effort,
    generate: impl FnOnce(&mut FunctionBuilder<'_>, Block) -> Option<T>,
) -> Option<(Code, *const u8, T)> {
    let effort = match effort {
        Effort::Loop => [("opt_level", "speed"), ("regalloc_algorithm", "backtracking")],
        Effort::Lasting => [("opt_level", "none"), ("regalloc_algorithm", "backtracking")],
        Effort::Fast => [("opt_level", "none"), ("regalloc_algorithm", "single_pass")],
    };
    let pinned = if matches!(effort[1].1, "single_pass") { "true" } else { "false" };
    let flags = [
        effort[0],
        effort[1],
        ("enable_pinned_reg", pinned),
        // A large frame must not reach beyond the end of the stack unnoticed.
        ("enable_probestack", "true"),
        ("probestack_strategy", "inline"),
        ("enable_verifier", "false"),
    ];
    let builder = JITBuilder::with_flags(&flags, default_libcall_names()).ok()?;
    let mut module = JITModule::new(builder);
    let mut context = module.make_context();
    let signature = &mut context.func.signature;
    signature.params.extend(vec![AbiParam::new(types::I64); words]);
    signature.returns.push(AbiParam::new(types::I64));
    let mut functions = FunctionBuilderContext::new();
    let mut f = FunctionBuilder::new(&mut context.func, &mut functions);
    let entry = f.create_block();
    f.append_block_params_for_function_params(entry);
    f.switch_to_block(entry);
    let generated = generate(&mut f, entry)?;
    f.seal_all_blocks();
    f.finalize();
    let id = module.declare_function("clocks", Linkage::Export, &context.func.signature).ok()?;
    module.define_function(id, &mut context).ok()?;
    let frame = context.compiled_code()?.buffer.frame_layout()?.frame_to_fp_offset;
    if frame > MOST_FRAME {
        return None;
    }
    module.clear_context(&mut context);
    module.finalize_definitions().ok()?;
    let address = module.get_finalized_function(id);
    Some((Code(Some(module)), address, generated))
}

/// Holds the memory of the code until it is dropped.
struct Code(Option<JITModule>);

impl Drop for Code {
    fn drop(&mut self) {
        if let Some(module) = self.0.take() {
            // SAFETY: the only pointer into the code is that of the value that owns this one, and nobody can call it any
            // more.
            unsafe { module.free_memory() };
        }
    }
}

/// A compiled loop that records no samples.
pub(super) struct Digester {
    _memory: Code,
    code: DigestLoop,
    state_words: usize,
    memory_words: usize,
    pub(super) layout: Layout,
    narrow: Vec<u32>,
    wide: Vec<i64>,
    words: Vec<u64>,
}

impl Digester {
    /// Compiles a plan; `None` where this machine has no code generator, or the plan writes memories, which a loop that is
    /// abandoned could not take back.
    pub(super) fn compile(plan: &Plan<'_>, wanted: &Wanted) -> Option<Digester> {
        let writes = plan.entry.netlist.memories.iter().any(|memory| !memory.writes.is_empty());
        let memory_words = plan.memory_words();
        if writes || memory_words > FARTHEST {
            return None;
        }
        let (memory, address, layout) =
            compiled(5, Effort::Loop, |f, entry| digesting::generate(plan, wanted, f, entry))?;
        // SAFETY: `address` is the start of a function just finalised, whose signature is that of `DigestLoop` in the
        // platform's C calling convention, the default of the module.
        let code = unsafe { std::mem::transmute::<*const u8, DigestLoop>(address) };
        let [narrow, wide, words] = layout.room();
        let (narrow, wide, words) = (vec![0; narrow], vec![0; wide], vec![0; words]);
        let state_words = plan.registers.len() + plan.inputs.len();
        Some(Digester { _memory: memory, code, state_words, memory_words, layout, narrow, wide, words })
    }

    /// Runs the clocks of a digest; `state` then holds the registers of the last one. False, with nothing changed, where
    /// the loop was abandoned.
    ///
    /// # Panics
    /// If `state` or `memories` is too short.
    pub(super) fn call(&mut self, state: &mut [u64], memories: &mut [u64]) -> bool {
        assert!(memories.len() >= self.memory_words, "{} words of memories", memories.len());
        assert!(state.len() >= self.state_words, "state of {} words", state.len());
        // SAFETY: the code touches `state_words` words of `state`, and of `narrow`, `wide` and `words` what its layout has
        // room for, which `compile` has allocated; it reads the words of `memories` that the plan names, calls nothing
        // and keeps no pointer. The module that holds it lives.
        let whole = unsafe {
            (self.code)(
                state.as_mut_ptr(),
                self.narrow.as_mut_ptr(),
                self.wide.as_mut_ptr(),
                self.words.as_mut_ptr(),
                memories.as_mut_ptr(),
            )
        };
        whole == 1
    }

    /// A narrow lane of the last call.
    pub(super) fn narrow(&self, lane: usize) -> &[u32] {
        &self.narrow[lane * self.layout.region()..][..self.layout.records()]
    }

    /// A wide lane of the last call.
    pub(super) fn wide(&self, lane: usize) -> &[i64] {
        &self.wide[lane * self.layout.region()..][..self.layout.records()]
    }

    /// The words of trains of the last call.
    pub(super) fn words(&self) -> &[u64] {
        &self.words
    }
}

/// The loop of lanes: frame, samples → samples done.
#[cfg(target_arch = "x86_64")]
type LaneFunction = unsafe extern "sysv64" fn(*mut u8, u64) -> u64;

/// Machine code of lanes, made without a compiler.
#[cfg(target_arch = "x86_64")]
pub(crate) struct LaneLoop {
    _memory: Mutex<Code>,
    code: LaneFunction,
    /// Bytes of the frame.
    frame: usize,
}

#[cfg(target_arch = "x86_64")]
impl LaneLoop {
    /// Puts code in memory; `None` where that is not possible, or this processor has no such instructions.
    pub(crate) fn of(compiled: &Compiled) -> Option<LaneLoop> {
        if !std::is_x86_feature_detected!("avx2") {
            return None;
        }
        let mut module = JITModule::new(JITBuilder::new(default_libcall_names()).ok()?);
        let signature = module.make_signature();
        let id = module.declare_function("lanes", Linkage::Export, &signature).ok()?;
        module.define_function_bytes(id, 32, compiled.code(), &[]).ok()?;
        module.finalize_definitions().ok()?;
        let address = module.get_finalized_function(id);
        // SAFETY: `address` is the start of a function just put there, which is a `LaneFunction`: only `lanes/avx` makes a
        // `Compiled`.
        let code = unsafe { std::mem::transmute::<*const u8, LaneFunction>(address) };
        Some(LaneLoop { _memory: Mutex::new(Code(Some(module))), code, frame: compiled.frame() })
    }

    /// Runs up to `samples` samples on a frame; gives their number.
    ///
    /// # Panics
    /// If the frame is too short.
    pub(crate) fn call<T: Lane>(&self, frame: &mut [T], samples: u64) -> u64 {
        assert!(size_of_val(frame) >= self.frame, "frame of {} bytes", size_of_val(frame));
        if samples == 0 {
            return 0;
        }
        // SAFETY: the code touches the first `self.frame` bytes of the frame, which are borrowed here, calls nothing and
        // keeps no pointer. Lanes are words without invalid patterns. The module that holds the code lives.
        unsafe { (self.code)(frame.as_mut_ptr().cast::<u8>(), samples) }
    }
}

#[cfg(target_arch = "x86_64")]
impl std::fmt::Debug for LaneLoop {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "LaneLoop with a frame of {} bytes", self.frame)
    }
}
