//! Memories: what a port writes at an edge, what a cell reads, and that the contents belong to the state.

use stepwave_engine::{Engine, EngineKind, Rows, Watch, at_rest, contents};
use stepwave_netlist::{Design, Net};

use crate::netlist::{design, net};

/// A memory of five words of four bits with two ports, the second with a mask, and one that reads.
fn two_ports() -> Design {
    design(|m| {
        let ram = m.scope("core").memory("ram", 4, 5).initial([1, 2, 3]);
        let [we0, we1] = ["we0", "we1"].map(|name| m.input(name, 1));
        let [a0, a1, read] = ["a0", "a1", "read"].map(|name| m.input(name, 4));
        let [d0, d1, mask] = ["d0", "d1", "mask"].map(|name| m.input(name, 4));
        m.name("out", ram.read(read));
        ram.write(we0, a0, d0, None);
        ram.write(we1, a1, d1, Some(mask));
    })
}

struct Ram {
    design: Design,
    engine: Box<dyn Engine>,
}

impl Ram {
    fn new(kind: EngineKind) -> Ram {
        let design = two_ports();
        let engine = kind.build(&design, &Watch::default());
        Ram { design, engine }
    }

    fn net(&self, name: &str) -> Net {
        net(&self.design, name)
    }

    /// Sets inputs, which change after an edge, and does the edge that they write at.
    fn clock(&mut self, set: &[(&str, u64)]) {
        for name in ["we0", "we1"] {
            self.engine.set_input(self.net(name), 0);
        }
        for (name, value) in set {
            self.engine.set_input(self.net(name), *value);
        }
        self.engine.run(2, &mut Rows::new(0, 0));
    }

    fn words(&self) -> Vec<u64> {
        contents(self.engine.as_ref(), &self.design).concat()
    }
}

#[test]
fn a_port_writes_at_the_edge_and_the_later_of_two_wins_bit_by_bit() {
    for kind in EngineKind::ALL {
        let mut ram = Ram::new(kind);
        assert_eq!(ram.words(), [1, 2, 3, 0, 0], "{}", kind.name());
        ram.clock(&[("we0", 1), ("a0", 3), ("d0", 9)]);
        assert_eq!(ram.words(), [1, 2, 3, 9, 0], "{}", kind.name());
        ram.clock(&[("we0", 1), ("a0", 4), ("d0", 0b1100), ("we1", 1), ("a1", 4), ("d1", 0b1010), ("mask", 0b0110)]);
        assert_eq!(ram.words(), [1, 2, 3, 9, 0b1010], "{}", kind.name());
        ram.clock(&[("we1", 1), ("a1", 0), ("d1", 0), ("mask", 0)]);
        assert_eq!(ram.words(), [1, 2, 3, 9, 0b1010], "{}", kind.name());
    }
}

#[test]
fn a_read_shows_the_present_word_and_0_outside_where_nothing_is_written_either() {
    for kind in EngineKind::ALL {
        let mut ram = Ram::new(kind);
        for address in 5..16 {
            ram.clock(&[("we0", 1), ("a0", address), ("d0", 15), ("read", address)]);
            assert_eq!(ram.engine.value(ram.net("out")), 0, "{}", kind.name());
            assert_eq!(ram.engine.word(0, address), 0, "{}", kind.name());
        }
        assert_eq!(ram.words(), [1, 2, 3, 0, 0], "{}", kind.name());
        // Written at the second edge, which the sample after it shows.
        ram.clock(&[("we0", 1), ("a0", 1), ("d0", 7), ("read", 1)]);
        assert_eq!(ram.engine.value(ram.net("out")), 7, "{}", kind.name());
    }
}

#[test]
fn a_reset_and_a_restored_state_have_their_contents() {
    for kind in EngineKind::ALL {
        let mut ram = Ram::new(kind);
        ram.clock(&[("we0", 1), ("a0", 0), ("d0", 8), ("read", 0)]);
        let inputs: Vec<u64> = ram.design.inputs().iter().map(|&input| ram.engine.value(input)).collect();
        let kept = contents(ram.engine.as_ref(), &ram.design);
        ram.clock(&[("we0", 1), ("a0", 0), ("d0", 5)]);
        ram.engine.restore(2, &[], &inputs, &kept);
        assert_eq!((ram.words(), ram.engine.value(ram.net("out"))), (vec![8, 2, 3, 0, 0], 8), "{}", kind.name());
        ram.engine.restore(2, &[], &inputs, &[]);
        assert_eq!(ram.words(), [1, 2, 3, 0, 0], "{}", kind.name());
        ram.clock(&[("we0", 1), ("a0", 0), ("d0", 5)]);
        ram.engine.reset(&mut Rows::new(0, 0));
        assert_eq!(ram.words(), [1, 2, 3, 0, 0], "{}", kind.name());
    }
}

#[test]
fn a_machine_whose_memory_is_about_to_change_is_not_at_rest() {
    for kind in EngineKind::ALL {
        let mut ram = Ram::new(kind);
        for (set, rests) in [
            (vec![("we0", 0), ("a0", 1), ("d0", 4)], true),
            (vec![("we0", 1), ("a0", 9), ("d0", 4)], true),
            (vec![("we0", 1), ("a0", 1), ("d0", 2)], true),
            (vec![("we0", 1), ("a0", 1), ("d0", 4)], false),
        ] {
            ram.engine.reset(&mut Rows::new(0, 0));
            ram.clock(&[]);
            for (name, value) in set {
                ram.engine.set_input(ram.net(name), value);
            }
            ram.engine.run(1, &mut Rows::new(0, 0));
            assert_eq!(at_rest(ram.engine.as_ref(), &ram.design, &[]), rests, "{}", kind.name());
        }
    }
}
