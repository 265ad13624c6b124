//! The words of a geometry on the inputs of a machine.

use stepwave_models::{CutWord, Loaded, Model, ModelError, Options, Words};
use stepwave_nc::Curve;

use super::Testbench;

/// Clocks after which a run with a load word that was cut, or of hardware of which nothing is known, is aborted: such a block
/// need not end.
pub const CUT_CLOCKS: u64 = 1 << 27;

/// Clocks that a curve takes at least: an axis moves by one BLU a clock at most. Nothing depends on the last digits.
#[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn least_clocks(curve: &Curve) -> u64 {
    (curve.length() / (curve.from().len() as f64).sqrt()) as u64
}

impl Testbench {
    /// Plans the hardware, builds the machine and encodes the load words, each of which must fit in its register.
    ///
    /// # Errors
    /// The model does not take the geometry or a choice, or a value does not fit in its register.
    pub fn new(model: &Model, curve: &Curve, choices: &Options) -> Result<Testbench, ModelError> {
        Testbench::of_hardware(model, model.plan(curve, choices)?)?.of(model, curve)
    }

    /// As [`new`](Self::new), but loads as the hardware does: see [`as_hardware_loads`](Self::as_hardware_loads).
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn loading(model: &Model, curve: &Curve, choices: &Options) -> Result<Testbench, ModelError> {
        Testbench::of_hardware(model, model.plan(curve, choices)?)?.as_hardware_loads().of(model, curve)
    }

    /// The same machine, which takes load words that do not fit as its registers take results that do not fit: with
    /// `--on-overflow wrap` cut, with `saturate` at an end of the range. [`cut_words`](Self::cut_words) lists them. Without
    /// this such words are refused for all hardware, so that no statement about all geometries rests on another
    /// one.
    #[must_use]
    pub fn as_hardware_loads(self) -> Testbench {
        Testbench { cuts: true, ..self }
    }

    /// The same hardware with the blocks of another geometry.
    ///
    /// # Errors
    /// A value does not fit in its register.
    pub fn of(&self, model: &Model, curve: &Curve) -> Result<Testbench, ModelError> {
        let loaded = self.load(&model.words(&self.hardware, curve)?)?;
        let (start, least_clocks) = (curve.from().to_vec(), least_clocks(curve));
        Ok(Testbench { blocks: loaded.blocks, cut: loaded.cut, start, least_clocks, ..self.clone() })
    }

    /// What the inputs are set to for these words.
    ///
    /// # Errors
    /// A value does not fit in its register.
    pub fn load(&self, words: &[Words]) -> Result<Loaded, ModelError> {
        if self.cuts {
            return self.machine.load(&self.hardware, words);
        }
        Ok(Loaded { blocks: self.machine.encode(&self.hardware, words)?, cut: Vec::new() })
    }

    /// The same bench, whose runs are aborted after this many clocks; without a number, and if a load word was cut or nothing
    /// is known of pauses of the hardware, after 2^27 clocks; each block of a program has as many.
    #[must_use]
    pub fn limited_to(self, clocks: Option<u64>) -> Testbench {
        let ends = self.blocks.is_empty() || self.cut.is_empty() && self.hardware.has_stall_clocks();
        let most = if ends { u64::MAX } else { CUT_CLOCKS };
        self.limited(clocks.unwrap_or(most))
    }

    /// Blocks that the geometry is loaded in.
    #[must_use]
    pub fn blocks(&self) -> usize {
        self.blocks.len()
    }

    /// Where the tool is before the first block, in BLU.
    #[must_use]
    pub fn start(&self) -> &[i64] {
        &self.start
    }

    /// The load words that did not fit in their registers.
    #[must_use]
    pub fn cut_words(&self) -> &[CutWord] {
        &self.cut
    }
}
