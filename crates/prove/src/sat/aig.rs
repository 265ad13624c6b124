//! And-inverter graphs: Boolean functions of variables, each node the conjunction of two literals.
//!
//! Equal nodes are made once, and what is constant is folded while it is made, so that a design unrolled from its reset
//! values shrinks to what depends on its inputs.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};
use std::ops::Not;

/// A node or its complement. Literals order by their nodes.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub(super) struct Literal(u32);

impl Literal {
    /// The constant 0.
    pub(super) const FALSE: Literal = Literal(0);
    /// The constant 1.
    pub(super) const TRUE: Literal = Literal(1);

    pub(super) fn constant(value: bool) -> Literal {
        if value { Literal::TRUE } else { Literal::FALSE }
    }

    pub(super) fn node(self) -> usize {
        (self.0 >> 1) as usize
    }

    pub(super) fn is_negated(self) -> bool {
        self.0 & 1 == 1
    }

    /// The literal, complemented if so asked.
    pub(super) fn negated_if(self, negate: bool) -> Literal {
        Literal(self.0 ^ u32::from(negate))
    }

    fn is_constant(self) -> bool {
        self.0 <= 1
    }
}

impl Not for Literal {
    type Output = Literal;

    fn not(self) -> Literal {
        Literal(self.0 ^ 1)
    }
}

/// Both operands of a variable.
const VARIABLE: [Literal; 2] = [Literal(u32::MAX); 2];

/// Mixes the two literals of a node: nothing here comes from a stranger.
#[derive(Default)]
struct Mixer(u64);

impl Hasher for Mixer {
    fn finish(&self) -> u64 {
        self.0 ^ self.0 >> 29
    }

    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|&byte| self.write_u32(u32::from(byte)));
    }

    fn write_u32(&mut self, value: u32) {
        self.0 = (self.0.rotate_left(23) ^ u64::from(value)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }
}

/// A graph. Node 0 is the constant 0; operands come before their node.
pub(super) struct Graph {
    nodes: Vec<[Literal; 2]>,
    known: HashMap<(Literal, Literal), u32, BuildHasherDefault<Mixer>>,
}

impl Graph {
    pub(super) fn new() -> Graph {
        Graph { nodes: vec![VARIABLE], known: HashMap::default() }
    }

    /// Number of nodes, which also numbers the next one.
    pub(super) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Operands of a node; `None` of variables and the constant.
    pub(super) fn operands(&self, node: usize) -> Option<[Literal; 2]> {
        Some(self.nodes[node]).filter(|&operands| operands != VARIABLE)
    }

    /// A new node. There are at most 2^31 - 1: the limit of memory is met long before.
    fn push(&mut self, operands: [Literal; 2]) -> Literal {
        let number = u32::try_from(self.nodes.len()).unwrap_or(u32::MAX >> 1).min(u32::MAX >> 1);
        self.nodes.push(operands);
        Literal(number << 1)
    }

    pub(super) fn variable(&mut self) -> Literal {
        self.push(VARIABLE)
    }

    pub(super) fn variables(&mut self, count: u32) -> Vec<Literal> {
        (0..count).map(|_| self.variable()).collect()
    }

    pub(super) fn and(&mut self, a: Literal, b: Literal) -> Literal {
        let (a, b) = if a <= b { (a, b) } else { (b, a) };
        if a == Literal::FALSE || a == !b {
            return Literal::FALSE;
        }
        if a == Literal::TRUE || a == b {
            return b;
        }
        // The greater literal may hold the lesser among its operands.
        if let Some(operands) = self.operands(b.node()) {
            match (operands.contains(&a), operands.contains(&!a), b.is_negated()) {
                (true, _, false) | (_, true, true) => return if b.is_negated() { a } else { b },
                (_, true, false) => return Literal::FALSE,
                // a & !(a & c) = a & !c
                (true, _, true) => {
                    let other = if operands[0] == a { operands[1] } else { operands[0] };
                    return self.and(a, !other);
                }
                (false, false, _) => {}
            }
        }
        if let Some(&number) = self.known.get(&(a, b)) {
            return Literal(number << 1);
        }
        let made = self.push([a, b]);
        self.known.insert((a, b), made.0 >> 1);
        made
    }

    pub(super) fn or(&mut self, a: Literal, b: Literal) -> Literal {
        !self.and(!a, !b)
    }

    pub(super) fn xor(&mut self, a: Literal, b: Literal) -> Literal {
        // One node for a ^ b, !a ^ b and the like.
        let negate = a.is_negated() ^ b.is_negated();
        let (a, b) = (a.negated_if(a.is_negated()), b.negated_if(b.is_negated()));
        if a.is_constant() || b.is_constant() {
            return if a.is_constant() { b } else { a }.negated_if(negate);
        }
        let (both, none) = (self.and(a, b), self.and(!a, !b));
        self.and(!both, !none).negated_if(negate)
    }

    /// `select` ? `high` : `low`
    pub(super) fn mux(&mut self, select: Literal, high: Literal, low: Literal) -> Literal {
        if high == low {
            return high;
        }
        if high == !low {
            return self.xor(select, low);
        }
        let (taken, other) = (self.and(select, high), self.and(!select, low));
        self.or(taken, other)
    }

    pub(super) fn any(&mut self, literals: impl IntoIterator<Item = Literal>) -> Literal {
        literals.into_iter().fold(Literal::FALSE, |any, literal| self.or(any, literal))
    }

    /// The operands of a node that is a multiplexer: select, high, low; of an exclusive or high is the complement of low.
    pub(super) fn as_mux(&self, node: usize) -> Option<[Literal; 3]> {
        let [x, y] = self.operands(node)?;
        if !x.is_negated() || !y.is_negated() {
            return None;
        }
        let ([a, b], [c, d]) = (self.operands(x.node())?, self.operands(y.node())?);
        // !(s & h) & !(!s & l) = s ? !h : !l
        let pairs = [(a, b, c, d), (a, b, d, c), (b, a, c, d), (b, a, d, c)];
        pairs.into_iter().find_map(|(s, high, t, low)| (s == !t).then_some([s, !high, !low]))
    }

    /// The value of every node under these values of the variables, by their nodes.
    pub(super) fn evaluate(&self, value: impl Fn(usize) -> bool) -> Vec<bool> {
        let mut values = vec![false; self.len()];
        for node in 1..self.len() {
            values[node] = match self.operands(node) {
                None => value(node),
                Some(operands) => operands.iter().all(|literal| values[literal.node()] != literal.is_negated()),
            };
        }
        values
    }
}

#[cfg(test)]
mod tests {
    use super::{Graph, Literal};

    /// Every function that these operators make of a few variables, folded while it is made, has the values of its
    /// definition.
    #[test]
    fn folding_keeps_every_function() {
        let mut graph = Graph::new();
        let variables = graph.variables(3);
        // Each literal with its truth table over the three variables.
        let mut made: Vec<(Literal, u8)> = vec![(Literal::FALSE, 0)];
        made.extend(variables.iter().zip([0b1010_1010, 0b1100_1100, 0b1111_0000]).map(|(&v, table)| (v, table)));
        let mut seed = 1u64;
        let mut random = |limit: usize| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            usize::try_from(seed >> 33).unwrap() % limit
        };
        for _ in 0..20_000 {
            let mut pick = || {
                let (literal, table) = made[random(made.len())];
                if random(2) == 1 { (!literal, !table) } else { (literal, table) }
            };
            let ((a, ta), (b, tb), (c, tc)) = (pick(), pick(), pick());
            let next = match random(4) {
                0 => (graph.and(a, b), ta & tb),
                1 => (graph.or(a, b), ta | tb),
                2 => (graph.xor(a, b), ta ^ tb),
                _ => (graph.mux(a, b, c), ta & tb | !ta & tc),
            };
            if made.len() < 3000 {
                made.push(next)
            } else {
                made[random(3000).max(4)] = next
            };
        }
        for point in 0..8usize {
            let values = graph.evaluate(|node| point >> (node - 1) & 1 == 1);
            for (literal, table) in &made {
                assert_eq!(values[literal.node()] != literal.is_negated(), table >> point & 1 == 1);
            }
            for node in 1..graph.len() {
                if let Some([select, high, low]) = graph.as_mux(node) {
                    let [s, h, l] = [select, high, low].map(|literal| values[literal.node()] != literal.is_negated());
                    assert_eq!(values[node], if s { h } else { l }, "node {node}");
                }
            }
        }
    }
}
