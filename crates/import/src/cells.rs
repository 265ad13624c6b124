//! What each combinational cell of Yosys computes, as `simlib.v` of Yosys defines it.

use stepwave_netlist::cells::Op;

use crate::ImportError;
use crate::design::Design;
use crate::json::{Cell, Wire};
use crate::word::Word;

/// Cells whose result bits depend on the operand bits of the same place alone: they can be taken apart bit by bit.
pub(crate) fn is_bitwise(kind: &str) -> bool {
    let kinds = ["$not", "$pos", "$and", "$or", "$xor", "$xnor", "$bweqx", "$mux", "$pmux", "$bwmux", "$buf"];
    kinds.contains(&kind)
}

/// Cells whose result bits depend on the operand bits of the same place and below, or from there on: arithmetic.
pub(crate) fn is_splittable(kind: &str) -> bool {
    is_bitwise(kind) || is_sum(kind) || is_shift(kind)
}

/// A result bit depends on the operand bits of its place and below.
fn is_sum(kind: &str) -> bool {
    matches!(kind, "$add" | "$sub" | "$neg" | "$mul")
}

fn is_shift(kind: &str) -> bool {
    matches!(kind, "$shl" | "$sshl" | "$shr" | "$sshr")
}

/// The bits of operand A (or B of a sum), of this many, on which a bit of the result depends.
pub(crate) fn lane_of(kind: &str, lane: usize, bits: usize) -> std::ops::RangeInclusive<usize> {
    // A narrower operand is extended by its last bit, or by zeros.
    let own = lane.min(bits.saturating_sub(1));
    match kind {
        "$shr" | "$sshr" => own..=bits.saturating_sub(1),
        kind if is_sum(kind) || is_shift(kind) => 0..=own,
        _ => own..=own,
    }
}

/// Clocked cells other than memories.
pub(crate) fn is_register(kind: &str) -> bool {
    matches!(
        kind,
        "$dff"
            | "$dffe"
            | "$adff"
            | "$adffe"
            | "$sdff"
            | "$sdffe"
            | "$sdffce"
            | "$aldff"
            | "$aldffe"
            | "$dffsr"
            | "$dffsre"
            | "$ff"
    )
}

/// Cells without hardware, which are passed over.
pub(crate) fn is_remark(kind: &str) -> bool {
    matches!(kind, "$scopeinfo" | "$print")
}

/// What to say of a kind of cell that is not imported.
pub(crate) fn refusal(kind: &str) -> String {
    let why = match kind {
        "$dlatch" | "$adlatch" | "$dlatchsr" => {
            "a latch cannot be simulated on a clock: assign the value in every branch, or clock it"
        }
        "$sr" => "a set/reset latch cannot be simulated on a clock: use a clocked register",
        "$tribuf" => "a tristate driver cannot be simulated: use a multiplexer",
        "$fsm" => "a state machine that was extracted cannot be imported: leave the pass fsm out",
        "$alu" | "$macc" | "$macc_v2" | "$lcu" | "$fa" => {
            "a cell of arithmetic optimisation cannot be imported: leave the passes alumacc and techmap out"
        }
        "$mem" | "$memrd" | "$memwr" | "$meminit" | "$memrd_v2" | "$memwr_v2" | "$meminit_v2" => {
            "a part of a memory: run the pass memory_collect (Yosys 0.13 or newer) before write_json"
        }
        "$anyconst" | "$anyseq" | "$allconst" | "$allseq" | "$initstate" => {
            "a formal input cannot be simulated: make it an input port"
        }
        kind if kind.starts_with("$specify") => "timing checks cannot be simulated: leave the specify block out",
        kind if kind.starts_with("$_") => "a gate cell: write the JSON before techmap and abc, at word level",
        kind if kind.starts_with('$') => "this kind of cell is not known",
        _ => "this module is not defined: give its file too, or a model of it",
    };
    why.to_owned()
}

/// Wires extended to a width by their last, or by 0, or cut.
fn stretched(wires: &[Wire], width: usize, signed: bool) -> Vec<Wire> {
    let fill = match wires.last() {
        Some(sign) if signed => sign.clone(),
        _ => Wire::Constant("0".to_owned()),
    };
    wires.iter().cloned().chain(std::iter::repeat(fill)).take(width).collect()
}

impl Design<'_> {
    /// An operand of this width; of one bit of it where a lane is given.
    fn operand(&mut self, wires: &[Wire], width: usize, signed: bool, lane: Option<usize>) -> Word {
        let wires = stretched(wires, width, signed);
        match lane {
            Some(lane) => self.word(&wires[lane..=lane]),
            None => self.word(&wires),
        }
    }

    /// One bit of the result of a cell of arithmetic, out of the operand bits on which it depends.
    fn arithmetic_lane(&mut self, cell: &Cell, lane: usize) -> Word {
        let (a, b, a_signed) = (cell.pin("A"), cell.pin("B"), cell.flag("A_SIGNED"));
        let signed = a_signed && (cell.kind == "$neg" || cell.flag("B_SIGNED"));
        let (result, bit) = if is_sum(&cell.kind) {
            let [x, y] = [a, b].map(|wires| self.operand(wires, lane + 1, signed, None));
            let result = if cell.kind == "$neg" { self.builder.negate(&x) } else { self.two(&cell.kind, &x, &y) };
            (result, lane)
        } else {
            let left = matches!(cell.kind.as_str(), "$shl" | "$sshl");
            let wires = stretched(a, a.len().max(cell.pin("Y").len()), a_signed);
            let word = self.word(if left { &wires[..=lane] } else { &wires[lane..] });
            let amount = self.word(b);
            let result = self.builder.shift(&word, &amount, left, a_signed && cell.kind == "$sshr");
            (result, if left { lane } else { 0 })
        };
        let net = self.builder.bit(&result, u32::try_from(bit).unwrap_or(0));
        Word { parts: vec![net], width: 1 }
    }

    /// The result of a combinational cell, or one bit of that of a splittable cell.
    pub(crate) fn logic(&mut self, name: &str, cell: &Cell, lane: Option<usize>) -> Result<Word, ImportError> {
        if let Some(lane) = lane.filter(|_| !is_bitwise(&cell.kind)) {
            return Ok(self.arithmetic_lane(cell, lane));
        }
        let (a, b) = (cell.pin("A"), cell.pin("B"));
        let (width, a_signed) = (cell.pin("Y").len(), cell.flag("A_SIGNED"));
        let signed = a_signed && cell.flag("B_SIGNED");
        let bits = u32::try_from(width).unwrap_or(u32::MAX);
        let flag = |this: &mut Self, net| this.flag_word(net, bits);
        Ok(match cell.kind.as_str() {
            "$pos" | "$buf" => self.operand(a, width, a_signed, lane),
            "$not" => {
                let a = self.operand(a, width, a_signed, lane);
                self.builder.not(&a)
            }
            "$neg" => {
                let a = self.operand(a, width, a_signed, None);
                self.builder.negate(&a)
            }
            "$and" | "$or" | "$xor" | "$xnor" | "$add" | "$sub" | "$mul" => {
                let [x, y] = [a, b].map(|wires| self.operand(wires, width, signed, lane));
                self.two(&cell.kind, &x, &y)
            }
            "$div" | "$mod" | "$divfloor" | "$modfloor" => {
                let wide = width.max(a.len()).max(b.len());
                let [x, y] = [a, b].map(|wires| self.operand(wires, wide, signed, None));
                let (quotient, rest) = self.builder.divide(&x, &y, signed, cell.kind.ends_with("floor"));
                let result = if cell.kind.starts_with("$div") { quotient } else { rest };
                self.builder.fit(&result, bits, signed)
            }
            "$bweqx" => {
                let [x, y] = [a, b].map(|wires| self.operand(wires, width, false, lane));
                self.two("$xnor", &x, &y)
            }
            "$lt" | "$le" | "$gt" | "$ge" | "$eq" | "$ne" | "$eqx" | "$nex" => {
                let wide = a.len().max(b.len());
                let [x, y] = [a, b].map(|wires| self.operand(wires, wide, signed, None));
                let net = self.compared(&cell.kind, &x, &y, signed);
                flag(self, net)
            }
            "$reduce_and" | "$reduce_or" | "$reduce_bool" | "$reduce_xor" | "$reduce_xnor" | "$logic_not" => {
                let a = self.word(a);
                let net = match cell.kind.as_str() {
                    "$reduce_and" => self.builder.every(&a),
                    "$reduce_or" | "$reduce_bool" => self.builder.any(&a),
                    "$reduce_xor" => self.builder.parity(&a),
                    "$reduce_xnor" => {
                        let odd = self.builder.parity(&a);
                        self.builder.invert(odd)
                    }
                    _ => {
                        let any = self.builder.any(&a);
                        self.builder.invert(any)
                    }
                };
                flag(self, net)
            }
            "$logic_and" | "$logic_or" => {
                let [a, b] = [a, b].map(|wires| {
                    let word = self.word(wires);
                    self.builder.any(&word)
                });
                let net = if cell.kind == "$logic_and" { self.builder.and(a, b) } else { self.builder.or(a, b) };
                flag(self, net)
            }
            "$mux" | "$pmux" | "$bwmux" | "$bmux" | "$demux" | "$slice" | "$concat" | "$lut" => self.chosen(cell, lane),
            "$shl" | "$sshl" | "$shr" | "$sshr" | "$shift" | "$shiftx" => self.shifted(cell),
            "$pow" => self.power(name, cell)?,
            kind => return Err(self.wrong(name, cell, refusal(kind))),
        })
    }

    fn two(&mut self, kind: &str, x: &Word, y: &Word) -> Word {
        match kind {
            "$and" => self.builder.bitwise(x, y, Op::And),
            "$or" => self.builder.bitwise(x, y, Op::Or),
            "$xor" => self.builder.bitwise(x, y, Op::Xor),
            "$xnor" => {
                let differ = self.builder.bitwise(x, y, Op::Xor);
                self.builder.not(&differ)
            }
            "$add" => self.builder.add(x, y, None).0,
            "$sub" => self.builder.sub(x, y),
            _ => self.builder.mul(x, y),
        }
    }

    fn compared(&mut self, kind: &str, x: &Word, y: &Word, signed: bool) -> stepwave_netlist::Net {
        let build = &mut self.builder;
        match kind {
            "$lt" => build.less(x, y, signed),
            "$gt" => build.less(y, x, signed),
            "$le" => {
                let more = build.less(y, x, signed);
                build.invert(more)
            }
            "$ge" => {
                let less = build.less(x, y, signed);
                build.invert(less)
            }
            "$eq" | "$eqx" => build.equal(x, y),
            _ => {
                let equal = build.equal(x, y);
                build.invert(equal)
            }
        }
    }

    /// Multiplexers and what only takes words apart.
    fn chosen(&mut self, cell: &Cell, lane: Option<usize>) -> Word {
        let (a, b, s, width) = (cell.pin("A"), cell.pin("B"), cell.pin("S"), cell.pin("Y").len());
        let of_lane = |wires: &[Wire]| match lane {
            Some(lane) => vec![wires[lane].clone()],
            None => wires.to_vec(),
        };
        match cell.kind.as_str() {
            "$mux" | "$pmux" => {
                let mut result = self.word(&of_lane(a));
                // The first of several that are 1 wins; Yosys makes them exclusive.
                for (select, choice) in s.iter().zip(b.chunks(width.max(1))).rev() {
                    let choice = self.word(&of_lane(choice));
                    let select = self.word(std::slice::from_ref(select)).parts[0];
                    result = self.builder.mux(select, &choice, &result);
                }
                result
            }
            "$bwmux" => {
                let [a, b, s] = [a, b, s].map(|wires| self.word(&of_lane(wires)));
                let (high, flipped) = (self.builder.bitwise(&b, &s, Op::And), self.builder.not(&s));
                let low = self.builder.bitwise(&a, &flipped, Op::And);
                self.builder.bitwise(&high, &low, Op::Or)
            }
            "$bmux" => {
                let choices = a.chunks(width.max(1)).map(|choice| self.word(choice)).collect();
                self.selected(choices, s)
            }
            "$demux" => {
                let slot = a.len();
                let zeros = vec![Wire::Constant("0".to_owned()); width];
                let at = |index: usize| {
                    let above = width.saturating_sub((index + 1) * slot);
                    [&zeros[..index * slot], a, &zeros[..above]].concat()
                };
                let choices = (0..width / slot.max(1)).map(|index| self.word(&at(index))).collect();
                self.selected(choices, s)
            }
            "$lut" => {
                let table = cell.bits("LUT");
                let entries = (0..1usize << a.len().min(20)).map(|index| table.get(index) == Some(&'1'));
                let entries: Vec<bool> = entries.collect();
                let choices = entries.into_iter().map(|bit| self.builder.number(u64::from(bit), 1)).collect();
                self.selected(choices, a)
            }
            "$slice" => {
                let offset = cell.number("OFFSET").and_then(|offset| usize::try_from(offset).ok()).unwrap_or(0);
                let wires: Vec<Wire> = a.iter().skip(offset).take(width).cloned().collect();
                self.word(&stretched(&wires, width, false))
            }
            _ => self.word(&[a, b].concat()),
        }
    }

    /// The word with the number that the select bits show; there are 2^bits of them.
    pub(crate) fn selected(&mut self, mut choices: Vec<Word>, select: &[Wire]) -> Word {
        for bit in select {
            let bit = self.word(std::slice::from_ref(bit)).parts[0];
            let pairs: Vec<Word> = choices
                .chunks(2)
                .map(|pair| match pair {
                    [low, high] => self.builder.mux(bit, high, low),
                    _ => pair[0].clone(),
                })
                .collect();
            choices = pairs;
        }
        choices.swap_remove(0)
    }

    fn shifted(&mut self, cell: &Cell) -> Word {
        let (a, b, width) = (cell.pin("A"), cell.pin("B"), cell.pin("Y").len());
        let bits = u32::try_from(width).unwrap_or(u32::MAX);
        // A part select reads zeros outside of A, whatever its sign.
        let a_signed = cell.flag("A_SIGNED") && cell.kind != "$shiftx";
        let wide = width.max(a.len());
        let (word, amount) = (self.operand(a, wide, a_signed, None), self.word(b));
        let both = matches!(cell.kind.as_str(), "$shift" | "$shiftx") && cell.flag("B_SIGNED");
        let left = matches!(cell.kind.as_str(), "$shl" | "$sshl");
        let mut result = self.builder.shift(&word, &amount, left, a_signed && cell.kind == "$sshr");
        if both {
            // -B of the least B has no sign: it is read as unsigned.
            let (negative, back) = (self.builder.bit(&amount, amount.width - 1), self.builder.negate(&amount));
            let left = self.builder.shift(&word, &back, true, false);
            result = self.builder.mux(negative, &left, &result);
        }
        self.builder.fit(&result, bits, false)
    }

    /// A power with a constant exponent, or of a constant power of two.
    fn power(&mut self, name: &str, cell: &Cell) -> Result<Word, ImportError> {
        let (a, b, width) = (cell.pin("A"), cell.pin("B"), cell.pin("Y").len());
        let bits = u32::try_from(width).unwrap_or(u32::MAX);
        let constant = |wires: &[Wire]| -> Option<u64> {
            wires.iter().enumerate().try_fold(0u64, |value, (bit, wire)| match wire {
                Wire::Constant(text) if text == "1" => (bit < 64).then(|| value | 1 << bit),
                Wire::Constant(_) => Some(value),
                Wire::Net(_) => None,
            })
        };
        let negative = cell.flag("B_SIGNED") && b.last() == Some(&Wire::Constant("1".to_owned()));
        if let Some(exponent) = constant(b).filter(|_| !negative) {
            let signed = cell.flag("A_SIGNED");
            let base = self.operand(a, width, signed, None);
            let mut result = self.builder.number(1, bits);
            for bit in (0..64 - exponent.leading_zeros()).rev() {
                result = self.builder.mul(&result, &result);
                if exponent >> bit & 1 == 1 {
                    result = self.builder.mul(&result, &base);
                }
            }
            return Ok(result);
        }
        if let Some(base) = constant(a).filter(|base| base.is_power_of_two() && !cell.flag("B_SIGNED")) {
            let amount = self.word(b);
            let (factor, one) = (base.trailing_zeros(), self.builder.number(1, bits));
            let factor = self.builder.number(u64::from(factor), amount.width + 7);
            let amount = self.builder.fit(&amount, amount.width + 7, false);
            let amount = self.builder.mul(&amount, &factor);
            return Ok(self.builder.shift(&one, &amount, true, false));
        }
        let why = "a power is imported with a constant exponent that is not negative, or of a constant power of two";
        Err(self.wrong(name, cell, why.to_owned()))
    }
}
