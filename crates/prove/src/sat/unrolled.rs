//! A design over some samples: one copy of its step for each, in one graph.

use std::rc::Rc;

use stepwave_netlist::Net;

use super::aig::Literal;
use super::solver::{Guard, Sat};
use super::template::Template;

/// What a sample is made of.
pub(super) struct Frame {
    /// Bits of the state.
    pub(super) state: Vec<Literal>,
    /// Bits of the inputs, one input after the other.
    pub(super) inputs: Vec<Literal>,
    /// The bits that the template was asked for.
    pub(super) roots: Vec<Literal>,
}

/// Samples of a design, one after the other.
pub(super) struct Unrolled<'t> {
    template: &'t Template,
    pub(super) sat: Sat,
    pub(super) frames: Vec<Frame>,
    /// The state of the sample to come.
    next: Vec<Literal>,
}

impl<'t> Unrolled<'t> {
    /// From the state before the first edge on.
    pub(super) fn from_reset(template: &'t Template, guard: &Rc<Guard>) -> Unrolled<'t> {
        let next = template.state.iter().map(|bit| Literal::constant(bit.first)).collect();
        Unrolled { template, sat: Sat::new(Rc::clone(guard)), frames: Vec::new(), next }
    }

    /// From any state on.
    pub(super) fn from_anywhere(template: &'t Template, guard: &Rc<Guard>) -> Unrolled<'t> {
        let mut sat = Sat::new(Rc::clone(guard));
        let next = template.state.iter().map(|_| sat.graph.variable()).collect();
        Unrolled { template, sat, frames: Vec::new(), next }
    }

    /// One more sample, with these inputs fixed and the others free.
    pub(super) fn push(&mut self, fixed: &[(Net, u64)]) {
        let template = self.template;
        let mut values = vec![Literal::FALSE; template.graph.len()];
        let state = std::mem::take(&mut self.next);
        template.state.iter().zip(&state).for_each(|(bit, &now)| values[bit.now.node()] = now);
        let mut inputs = Vec::new();
        for (net, word) in &template.inputs {
            let given = fixed.iter().find(|(input, _)| input == net).map(|&(_, value)| value);
            for (place, variable) in word.iter().enumerate() {
                let bit = match given {
                    Some(value) => Literal::constant(value >> place & 1 == 1),
                    None => self.sat.graph.variable(),
                };
                values[variable.node()] = bit;
                inputs.push(bit);
            }
        }
        for &node in &template.cone {
            if let Some(operands) = template.graph.operands(node) {
                let [a, b] = operands.map(|operand| values[operand.node()].negated_if(operand.is_negated()));
                values[node] = self.sat.graph.and(a, b);
            }
        }
        let of = |literal: Literal| values[literal.node()].negated_if(literal.is_negated());
        self.next = template.state.iter().map(|bit| of(bit.next)).collect();
        let roots = template.roots.iter().map(|&root| of(root)).collect();
        self.frames.push(Frame { state, inputs, roots });
    }
}
