//! One mistake, one diagnostic: what follows from a mistake is not reported.

use stepwave_netlist::cells::Format;
use stepwave_netlist::dsl::{Module, Scope, Signal};
use stepwave_netlist::{Code, Diagnostic, OnOverflow};

/// All that is said of a description in a module `m`, for every mode of its strict cells.
fn said(describe: impl Fn(Scope<'_>)) -> Vec<Diagnostic> {
    let all = [OnOverflow::Trap, OnOverflow::Saturate, OnOverflow::Wrap].map(|mode| {
        let module = Module::with_overflow("m", mode);
        describe(module.top());
        module.finish().expect_err("a mistake is reported").0
    });
    assert!(all[0] == all[1] && all[0] == all[2], "{all:?}");
    let [said, ..] = all;
    said
}

/// One diagnostic only, with this code and message.
fn assert_one(describe: impl Fn(Scope<'_>), code: Code, message: &str) {
    let said = said(describe);
    let found: Vec<(Code, &str)> = said.iter().map(|d| (d.code, d.message.as_str())).collect();
    assert_eq!(found, [(code, message)]);
    assert!(said[0].place.to_string().contains("one_mistake.rs:"), "{}", said[0]);
}

/// An operator on two signals.
type Operator = for<'m> fn(Signal<'m>, Signal<'m>) -> Signal<'m>;

#[test]
fn a_carrying_sum_or_borrowing_difference_of_unequal_widths_is_one_mistake() {
    let operators: [Operator; 2] = [
        |a, b| {
            let (carry, sum) = a.carrying_add(b);
            carry.mux(sum, a)
        },
        |a, b| {
            let (borrow, difference) = a.borrowing_sub(b);
            borrow.mux(difference, a)
        },
    ];
    for operator in operators {
        let message = "m.a (4 bits) and m.b (5 bits) are not equally wide";
        assert_one(
            |m| {
                m.reg("r", 4).set(operator(m.input("a", 4), m.input("b", 5)));
            },
            Code::WidthMismatch,
            message,
        );
    }
}

#[test]
fn an_exact_result_of_more_than_64_bits_is_one_mistake_that_names_both_operands() {
    let sums: [Operator; 2] = [|a, b| a.strict_add(b, a.bit(0)), |a, b| a.saturating_add(b)];
    let differences: [Operator; 2] = [|a, b| a.strict_sub(b, a.bit(0)), |a, b| a.saturating_sub(b)];
    let most = "64 is the most";
    for (operators, what) in [(sums, "sum"), (differences, "difference")] {
        for operator in operators {
            assert_one(
                |m| {
                    let (a, b) = (m.input("a", 64), m.input_signed("b", 3));
                    let _ = m.name("result", operator(a, b)).wrapping_add(a);
                },
                Code::BadWidth,
                &format!(
                    "the exact {what} of m.a (64 bits) and m.b (3 bits) needs two's complement of 66 bits; {most}"
                ),
            );
            assert_one(
                |m| {
                    let (a, b) = (m.input_signed("a", 3), m.input("b", 63));
                    m.reg_signed("r", 3).set(operator(a, b));
                },
                Code::BadWidth,
                &format!(
                    "the exact {what} of m.a (3 bits) and m.b (63 bits) needs two's complement of 65 bits; {most}"
                ),
            );
        }
    }
}

#[test]
fn a_strict_cell_with_an_enable_of_several_bits_is_one_mistake() {
    assert_one(
        |m| {
            let (a, enable) = (m.input("a", 4), m.input("enable", 2));
            m.name("sum", a.strict_add(a, enable));
        },
        Code::NotOneBit,
        "m.enable (2 bits) enables, so it must be 1 bit",
    );
}

#[test]
fn a_width_that_is_not_possible_is_one_mistake_whatever_is_done_with_the_signal() {
    let bad =
        |of: &str, bits: u32| format!("{of}a width of {bits} bits is not possible: a register holds 1 to 64 bits");
    type Make = for<'m> fn(Scope<'m>) -> Signal<'m>;
    let makes: [(&str, u32, Make); 13] = [
        ("a: ", 65, |m| m.input("a", 65)),
        ("a: ", 0, |m| m.input_signed("a", 0)),
        ("", 65, |m| m.lit(65, 17)),
        ("", 0, |m| m.lit(0, 17)),
        ("", 65, |m| m.lit_signed(65, -17)),
        ("", 0, |m| m.lit_signed(0, -17)),
        ("", 65, |m| m.input("a", 4).extend(65)),
        ("", 70, |m| m.input_signed("a", 4).extend(70)),
        ("", 0, |m| m.input("a", 4).extend(0)),
        ("", 65, |m| m.input("a", 4).slice(0, 65)),
        ("", 0, |m| m.input("a", 4).slice(9, 0)),
        ("", 65, |m| m.input("a", 40).concat(m.input("b", 25))),
        ("", 70, |m| m.input("a", 64).extend(70).slice(66, 2)),
    ];
    for (of, bits, make) in makes {
        assert_one(
            |m| {
                let (signal, other) = (make(m), m.input("other", 7));
                let (_, sum) = signal.carrying_add(other);
                m.name("mixed", sum.slice(3, 4) & other.slice(0, 5));
                m.reg("r", 7).set(other.is_zero().mux(signal, other));
                m.name("wide", signal.concat(m.input("wide_b", 60)));
                m.name("exact", m.name("named", signal).strict_sub(m.input("wide_c", 64), signal));
                m.invariant("never", signal);
            },
            Code::BadWidth,
            &bad(of, bits),
        );
    }
    for bits in [0, 65] {
        assert_one(
            |m| {
                let r = m.reg("r", bits).reset(9);
                r.when(m.input("load", 1), m.input("a", 9)).else_hold();
            },
            Code::BadWidth,
            &bad("r: ", bits),
        );
    }
}

#[test]
fn an_operand_of_another_module_is_a_mistake_even_where_a_net_of_its_number_exists_here() {
    let operators: [Operator; 16] = [
        |a, b| a & b,
        |a, b| a | b,
        |a, b| a ^ b,
        |a, b| a.wrapping_add(b),
        |a, b| a.wrapping_sub(b),
        |a, b| a.carrying_add(b).0,
        |a, b| a.borrowing_sub(b).1,
        |a, b| a.saturating_add(b),
        |a, b| a.saturating_sub(b),
        |a, b| a.strict_add(b, a.bit(0)),
        |a, b| a.strict_sub(a, b.bit(0)),
        |a, b| a.equals(b),
        |a, b| a.less_than(b),
        |a, b| a.concat(b),
        |a, b| a.bit(0).mux(b, a),
        |a, b| a.bit(0).mux(a, b),
    ];
    // The other module has fewer nets, or as many and wider ones.
    for bits in [4, 5] {
        for (index, operator) in operators.into_iter().enumerate() {
            let other = Module::new("other");
            for extra in 0..3 {
                let _ = other.top().input(&format!("extra{extra}"), 1);
            }
            let foreign = other.top().input("x", bits);
            let module = Module::new("m");
            let m = module.top();
            let a = m.input("a", 4);
            m.name("r", operator(a, foreign));
            let said = module.finish().unwrap_err().0;
            assert_eq!(said.len(), 1, "operator {index}: {said:?}");
            assert_eq!(said[0].code, Code::ForeignSignal, "operator {index}");
            assert!(said[0].place.to_string().contains("one_mistake.rs:"), "{}", said[0]);
            assert!(said[0].message.ends_with(" is a signal of another module, not of m"), "{}", said[0]);
            assert!(other.finish().is_ok(), "operator {index}: nothing is wrong with the other module");
        }
    }
}

#[test]
fn a_signal_of_another_module_drives_no_register_and_bears_no_name_here() {
    type Use = for<'m> fn(Scope<'m>, Signal<'m>);
    let uses: [Use; 7] = [
        |m, x| m.reg("r", 4).set(x),
        |m, x| m.reg("r", 4).when(x.bit(0), m.lit(4, 1)).else_hold(),
        |m, x| m.reg("r", 4).when(m.input("a", 1), x).else_hold(),
        |m, x| m.reg("r", 4).when(m.input("a", 1), m.lit(4, 1)).otherwise(x),
        |m, x| _ = m.name("n", x),
        |m, x| _ = m.show("n", x, Format::Binary),
        |m, x| m.invariant("holds", x.bit(0)),
    ];
    for (index, describe) in uses.into_iter().enumerate() {
        let other = Module::new("other");
        let foreign = other.top().input("x", 4);
        let module = Module::new("m");
        describe(module.top(), foreign);
        let said = module.finish().unwrap_err().0;
        let codes: Vec<Code> = said.iter().map(|diagnostic| diagnostic.code).collect();
        assert_eq!(codes, [Code::ForeignSignal], "use {index}: {said:?}");
    }
}

#[test]
fn a_part_that_is_given_signals_of_another_module_reports_every_one() {
    let other = Module::new("other");
    let (s, x) = (other.top().input("s", 1), other.top().input("x", 4));
    let module = Module::new("m");
    let m = module.top();
    m.reg("r", 4).when(s, x).else_hold();
    let messages: Vec<String> = module.finish().unwrap_err().0.into_iter().map(|d| d.message).collect();
    let foreign = |signal: &str| format!("{signal} is a signal of another module, not of m");
    assert_eq!(messages, [foreign("other.s (1 bit)"), foreign("other.x (4 bits)")]);
}
