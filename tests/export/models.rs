//! BTOR2 and SMT-LIB 2 as text; `.ci/solvers` gives them to model checkers and solvers.

use stepwave_export::{Checking, btor2, smt2};
use stepwave_netlist::{Design, elaborate, text};

fn parsed(netlist: &str) -> Design {
    elaborate(text::parse(netlist).unwrap()).unwrap()
}

/// A register that adds an input in the clocks in which another is 1; its carry has two names.
fn adder() -> Design {
    parsed(
        "netlist m\nscope 1 in 0 \"part\"\n%0:4 = input\n%1:1 = input\n%2:4 = register reset 0x5 next %5\n\
         %3:4 = add %2 %0\n%4:1 = carry %2 %0\n%5:4 = mux %1 %3 %2\n\
         name %0 in 0 \"a\" unsigned\nname %1 in 0 \"go\" unsigned\nname %2 in 0 \"r\" signed\n\
         name %4 in 0 \"c\" unsigned\nname %4 in 1 \"carry\" unsigned\n\
         property \"m.r\" never %4 add %2 unsigned %0 unsigned\n",
    )
}

#[test]
fn a_small_machine_in_btor2() {
    let design = adder();
    let (comment, held) = (["an adder".to_owned()], [design.inputs()[1]]);
    let expected = "; an adder\n1 sort bitvec 4\n2 input 1 m.a\n3 sort bitvec 1\n4 state 3 m.go\n5 constd 1 5\n\
                    6 state 1 m.r\n7 init 1 6 5\n8 add 1 6 2\n9 sort bitvec 5\n10 uext 9 6 1\n11 uext 9 2 1\n\
                    12 add 9 10 11\n13 slice 3 12 4 4 m.c\n14 ite 1 4 8 6\n15 output 13 m.part.carry\n\
                    16 next 1 6 14\n17 next 3 4 4\n18 bad 13 never.m.c\n";
    assert_eq!(btor2(&design, &Checking { comment: &comment, held: &held }).unwrap(), expected);
    // Not held, it is an input as any other.
    let open = btor2(&design, &Checking::default()).unwrap();
    assert!(open.contains("\n4 input 3 m.go\n") && !open.contains("next 3"), "{open}");
}

#[test]
fn a_small_machine_in_smt_lib() {
    let design = adder();
    let (comment, held) = (["an adder".to_owned()], [design.inputs()[1]]);
    let written = smt2(&design, &Checking { comment: &comment, held: &held }, 1).unwrap();
    assert_eq!(written, include_str!("adder.smt2"), "\n{written}");
    // Not held, it is a constant of each clock.
    let open = smt2(&design, &Checking::default(), 0).unwrap();
    assert!(open.contains("(declare-const m.go@0 (_ BitVec 1))") && open.contains("(settled m.a@0 m.go@0 "), "{open}");
}

#[test]
fn every_operator_is_written_in_both_languages() {
    for (operator, width, expected_btor2, expected_smt2) in [
        ("not %0", 4, "6 not 1 2 m.out", "(bvnot m.a)"),
        ("and %0 %1", 4, "6 and 1 2 3 m.out", "(bvand m.a m.b)"),
        ("or %0 %1", 4, "6 or 1 2 3 m.out", "(bvor m.a m.b)"),
        ("xor %0 %1", 4, "6 xor 1 2 3 m.out", "(bvxor m.a m.b)"),
        ("mux %2 %0 %1", 4, "6 ite 1 5 2 3 m.out", "(ite (= m.s #b1) m.a m.b)"),
        ("add %0 %1", 4, "6 add 1 2 3 m.out", "(bvadd m.a m.b)"),
        ("sub %1 %0", 4, "6 sub 1 3 2 m.out", "(bvsub m.b m.a)"),
        ("equal %0 %1", 1, "6 eq 4 2 3 m.out", "(bvcomp m.a m.b)"),
        ("borrow %0 %1", 1, "6 ult 4 2 3 m.out", "(ite (bvult m.a m.b) #b1 #b0)"),
        ("less-signed %0 %1", 1, "6 slt 4 2 3 m.out", "(ite (bvslt m.a m.b) #b1 #b0)"),
        ("slice %0 1", 2, "6 sort bitvec 2|7 slice 6 2 2 1 m.out", "((_ extract 2 1) m.a)"),
        ("concat %2 %0", 5, "6 sort bitvec 5|7 concat 6 5 2 m.out", "(concat m.s m.a)"),
        ("zero-extend %0", 64, "6 sort bitvec 64|7 uext 6 2 60 m.out", "((_ zero_extend 60) m.a)"),
        ("sign-extend %0", 4, "6 sext 1 2 0 m.out", "((_ sign_extend 0) m.a)"),
        (
            "carry %0 %1",
            1,
            "6 sort bitvec 5|7 uext 6 2 1|8 uext 6 3 1|9 add 6 7 8|10 slice 4 9 4 4 m.out",
            "((_ extract 4 4) (bvadd ((_ zero_extend 1) m.a) ((_ zero_extend 1) m.b)))",
        ),
        (
            "add-overflow %0 %1",
            1,
            "6 sort bitvec 5|7 sext 6 2 1|8 sext 6 3 1|9 add 6 7 8|10 slice 4 9 4 4|11 slice 4 9 3 3|12 xor 4 10 11 m.out",
            "(bvxor ((_ extract 4 4) (bvadd ((_ sign_extend 1) m.a) ((_ sign_extend 1) m.b))) \
             ((_ extract 3 3) (bvadd ((_ sign_extend 1) m.a) ((_ sign_extend 1) m.b))))",
        ),
        (
            "sub-overflow %0 %1",
            1,
            "6 sort bitvec 5|7 sext 6 2 1|8 sext 6 3 1|9 sub 6 7 8|10 slice 4 9 4 4|11 slice 4 9 3 3|12 xor 4 10 11 m.out",
            "(bvxor ((_ extract 4 4) (bvsub ((_ sign_extend 1) m.a) ((_ sign_extend 1) m.b))) \
             ((_ extract 3 3) (bvsub ((_ sign_extend 1) m.a) ((_ sign_extend 1) m.b))))",
        ),
    ] {
        let design = parsed(&format!(
            "netlist m\n%0:4 = input\n%1:4 = input\n%2:1 = input\n%3:{width} = {operator}\n\
             name %0 in 0 \"a\" unsigned\nname %1 in 0 \"b\" unsigned\nname %2 in 0 \"s\" unsigned\n\
             name %3 in 0 \"out\" unsigned\n"
        ));
        let model = btor2(&design, &Checking::default()).unwrap();
        let inputs = "1 sort bitvec 4\n2 input 1 m.a\n3 input 1 m.b\n4 sort bitvec 1\n5 input 4 m.s\n";
        let lines = model.strip_prefix(inputs).unwrap_or_else(|| panic!("{model}"));
        assert_eq!(lines.trim_end().replace('\n', "|"), expected_btor2, "{operator}");
        let script = smt2(&design, &Checking::default(), 0).unwrap();
        assert!(script.contains(&format!("\n  (= m.out {expected_smt2}))\n")), "{operator}: {script}");
    }
}

#[test]
fn constants_are_written_where_they_are_read_and_named_ones_bear_their_names() {
    let design = parsed(
        "netlist m\n%0:3 = input\n%1:3 = const 0x5\n%2:3 = const 0x5\n%3:3 = add %0 %1\n%4:3 = sub %3 %2\n\
         name %0 in 0 \"a\" unsigned\nname %2 in 0 \"five\" unsigned\nname %4 in 0 \"out\" unsigned\n",
    );
    let model = btor2(&design, &Checking::default()).unwrap();
    let expected = "1 sort bitvec 3\n2 input 1 m.a\n3 constd 1 5 m.five\n4 add 1 2 3\n5 sub 1 4 3 m.out\n";
    assert_eq!(model, expected);
    let script = smt2(&design, &Checking::default(), 0).unwrap();
    let settled = "    (= m.five #b101)\n    (= n3 (bvadd m.a #b101))\n    (= m.out (bvsub n3 m.five))))\n";
    assert!(script.contains(settled), "{script}");
}

#[test]
fn a_property_in_words_has_a_name_of_its_own_that_every_tool_takes() {
    let design = parsed(
        "netlist m\n%0:1 = input\n%1:1 = not %0\n%2:1 = not %1\nname %0 in 0 \"a\" unsigned\n\
         property \"m.it; is\\n|so|\" never %1 invariant\nproperty \"m.it; is\\n|so|\" never %2 invariant\n",
    );
    let model = btor2(&design, &Checking::default()).unwrap();
    assert!(model.ends_with("5 bad 3 never.m.it__is__so_\n6 bad 4 never.m.it__is__so__1\n"), "{model}");
    let script = smt2(&design, &Checking::default(), 0).unwrap();
    let violated = "  (or\n    (= n1 #b1) ; never.m.it__is__so_\n    (= n2 #b1) ; never.m.it__is__so__1\n  ))\n";
    assert!(script.contains(violated), "{script}");
}

#[test]
fn without_registers_or_properties_nothing_is_ever_violated() {
    let design = parsed("netlist m\n%0:1 = input\nname %0 in 0 \"a\" unsigned\n");
    assert_eq!(btor2(&design, &Checking::default()).unwrap(), "1 sort bitvec 1\n2 input 1 m.a\n");
    let script = smt2(&design, &Checking::default(), 2).unwrap();
    assert!(script.contains("(assert init)\n(assert (settled m.a@0))\n"), "{script}");
    assert!(script.ends_with("\n; The question.\n(assert (or violated violated violated))\n(check-sat)\n"), "{script}");
}

#[test]
fn a_memory_is_refused_by_its_name() {
    let design = parsed("netlist m\nmemory 0 in 0 \"ram\" width 4 words 8\n%0:3 = input\n%1:4 = read 0 %0\n");
    let said = btor2(&design, &Checking::default()).unwrap_err().to_string();
    assert_eq!(said, "model checkers cannot take the memory m.ram: give a design without memories");
    let said = smt2(&design, &Checking::default(), 1).unwrap_err().to_string();
    assert_eq!(said, "solvers cannot take the memory m.ram: give a design without memories");
}
