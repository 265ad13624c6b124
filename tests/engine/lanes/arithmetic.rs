//! What lanes make of sums under conditions: the counters and accumulators of interpolators, all widths of up to three
//! bits and all values, against the word engine.

use stepwave_engine::lanes::{Job, LaneProgram, LaneWatch, Observe};
use stepwave_engine::{EngineKind, Rows, Watch};
use stepwave_netlist::{Design, Net, OnOverflow};

use crate::netlist::{design_with, net, values};

/// A register that is loaded, then adds or subtracts an operand, or 1 where there is none, for two clocks.
fn counter(mode: OnOverflow, bits: u32, signed: bool, operand: Option<(u32, bool)>) -> Design {
    design_with(mode, |m| {
        let [load, count, down] = ["load", "count", "down"].map(|name| m.input(name, 1));
        let (word, r) = if signed {
            (m.input_signed("word", bits), m.reg_signed("r", bits))
        } else {
            (m.input("word", bits), m.reg("r", bits))
        };
        let right = match operand {
            None => m.lit(bits, 1),
            Some((bits, true)) => m.input_signed("right", bits),
            Some((bits, false)) => m.input("right", bits),
        };
        let right = if operand.is_none() && signed { right.as_signed() } else { right };
        let (up, down) = (count & !down, count & down);
        let (sum, difference) = (r.q.strict_add(right, up), r.q.strict_sub(right, down));
        r.when(load, word).when(up, sum).when(down, difference).else_hold();
        let age = m.reg("age", 2);
        age.when(load, m.lit(2, 1)).otherwise(age.q.wrapping_add(m.lit(2, 1)));
        m.name("done", age.q.equals(m.lit(2, 3)));
    })
}

/// The values of the nets in the last sample of a job, run alone: the block, then two clocks at rest.
fn alone(design: &Design, block: &[(Net, u64)], nets: &[Net]) -> (Vec<u64>, Vec<u64>) {
    let mut engine = EngineKind::Word.build(design, &Watch { columns: nets.to_vec(), stops: vec![] });
    let mut rows = Rows::new(nets.len(), 8);
    block.iter().for_each(|&(net, value)| engine.set_input(net, value));
    engine.reset(&mut rows);
    engine.set_input(net(design, "load"), 0);
    engine.run(3, &mut rows);
    let count = |column| rows.iter().filter(|(_, row)| row[column] != 0).count() as u64;
    (rows.row(3).to_vec(), (0..nets.len()).map(count).collect())
}

#[test]
fn counters_and_accumulators_of_every_width_and_reading_count_in_lanes_as_alone() {
    for mode in [OnOverflow::Wrap, OnOverflow::Saturate] {
        for (bits, signed) in (1..=3).flat_map(|bits| [(bits, false), (bits, true)]) {
            let operands = (1..=4).flat_map(|bits| [Some((bits, false)), Some((bits, true))]);
            for operand in [None].into_iter().chain(operands) {
                let design = counter(mode, bits, signed, operand);
                let nets = ["r", "r_add_overflow", "r_sub_overflow"].map(|name| net(&design, name));
                let load = net(&design, "load");
                let observe = nets.map(Observe::Last).into_iter().chain(nets.map(|net| Observe::Count(vec![net])));
                let watch = LaneWatch {
                    rest: vec![(load, 0)],
                    observe: observe.collect(),
                    ..LaneWatch::new(net(&design, "done"))
                };
                let mut blocks = Vec::new();
                for word in values(bits) {
                    for right in values(operand.map_or(1, |(bits, _)| bits)) {
                        for (count, down) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                            let mut block = vec![(load, 1), (net(&design, "word"), word)];
                            block.extend([(net(&design, "count"), count), (net(&design, "down"), down)]);
                            block.extend(operand.map(|_| (net(&design, "right"), right)));
                            blocks.push(block);
                        }
                    }
                }
                let jobs = blocks.iter().map(|block| Job { blocks: vec![block.clone()] }).collect();
                let ends = LaneProgram::new(&design, &watch).run_all(jobs);
                for (block, end) in blocks.iter().zip(ends) {
                    let (last, counts) = alone(&design, block, &nets);
                    let what = format!("{mode:?}, {bits} bits, signed {signed}, operand {operand:?}, {block:?}");
                    assert_eq!((end.clock, end.values), (3, [last, counts].concat()), "{what}");
                }
            }
        }
    }
}

#[test]
fn the_widest_nets_of_either_word_hold_all_their_bits() {
    for bits in [31, 32, 33, 34, 63, 64] {
        let design = design_with(OnOverflow::Wrap, |m| {
            let (load, word) = (m.input("load", 1), m.input("word", bits));
            let r = m.reg("r", bits);
            r.when(load, word).otherwise(r.q.wrapping_add(m.lit(bits, 1)));
            m.name("done", !load);
        });
        let [load, word, r, done] = ["load", "word", "r", "done"].map(|name| net(&design, name));
        let watch = LaneWatch { rest: vec![(load, 0)], observe: vec![Observe::Last(r)], ..LaneWatch::new(done) };
        let mask = u64::MAX >> (64 - bits);
        let words = [0, 1, mask, mask - 1, mask / 2, mask / 2 + 1];
        let jobs = words.iter().map(|&value| Job { blocks: vec![vec![(load, 1), (word, value)]] }).collect();
        let ends = LaneProgram::new(&design, &watch).run_all(jobs);
        // Done in sample 1, after the edge that loads.
        let last: Vec<u64> = ends.iter().map(|end| end.values[0]).collect();
        assert_eq!(last, words, "{bits} bits");
    }
}
