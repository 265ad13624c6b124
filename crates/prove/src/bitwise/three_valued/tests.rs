//! Three-valued simulation against an engine, on random netlists of every operator.

use super::*;
use crate::polynomial::random::{Dice, netlist};
use stepwave_engine::{EngineKind, Rows, Watch};
use stepwave_netlist::elaborate;

#[test]
fn known_bits_give_what_the_engine_has_and_unknown_ones_never_leave_it_out() {
    let mut dice = Dice(0x9055);
    let (mut known, mut open) = (0, 0);
    for _ in 0..300 {
        let netlist = netlist(&mut dice);
        let design = elaborate(netlist.clone()).unwrap();
        let mut sample = ThreeValued::new(&design);
        // What the registers hold in each lane; the last lanes do not know one bit of three.
        let mut held = vec![Vec::new(); 64];
        for register in design.registers() {
            let mut columns = vec![Bit { zero: 0, one: 0 }; netlist.width(*register).get() as usize];
            for (lane, held) in held.iter_mut().enumerate() {
                let mut word = 0;
                for (place, bit) in columns.iter_mut().enumerate() {
                    let is = dice.below(2) == 1;
                    let unknown = lane >= 16 && dice.below(3) == 0;
                    word |= u64::from(is) << place;
                    bit.one |= u64::from(is || unknown) << lane;
                    bit.zero |= u64::from(!is || unknown) << lane;
                }
                held.push(word);
            }
            sample.of_mut(*register).copy_from_slice(&columns);
        }
        let mut engines: Vec<_> = held
            .iter()
            .map(|held| {
                let mut engine = EngineKind::Gates.build(&design, &Watch::default());
                engine.restore(0, held, &[], &[]);
                engine
            })
            .collect();
        for clock in 0..2 {
            sample.settle(None);
            for net in netlist.nets() {
                for (lane, engine) in engines.iter().enumerate() {
                    let word = engine.value(net);
                    for (place, bit) in sample.of(net).iter().enumerate() {
                        let is = word >> place & 1 == 1;
                        let may = [bit.zero, bit.one].map(|lanes| lanes >> lane & 1 == 1);
                        let what = || format!("bit {place} of {} in lane {lane}, clock {clock}", netlist.describe(net));
                        assert!(may[usize::from(is)], "{}", what());
                        assert!(lane >= 16 || !may[usize::from(!is)], "{}", what());
                        known += usize::from(lane >= 16 && !may[usize::from(!is)]);
                        open += usize::from(may[usize::from(!is)]);
                    }
                }
            }
            sample.edge();
            engines.iter_mut().for_each(|engine| _ = engine.run(1, &mut Rows::new(0, 0)));
        }
    }
    assert!(known > 100_000 && open > 100_000, "{known} known, {open} open");
}

#[test]
fn a_net_that_is_cut_off_keeps_what_it_was_given() {
    let mut dice = Dice(3);
    let design = elaborate(netlist(&mut dice)).unwrap();
    let mut sample = ThreeValued::new(&design);
    let cut = design.netlist().nets().last().unwrap();
    sample.set(cut, 1);
    sample.settle(Some(cut));
    assert_eq!(sample.of(cut)[0], Bit::all(true));
    sample.settle(None);
    assert_eq!(sample.of(cut)[0], Bit::X);
}
