//! What many samples came to where nobody has to see each of them: extremes of registers, the samples in which a net was
//! not 0, extremes of a quadratic form.

use stepwave_netlist::cells::{Net, Netlist};

use super::Extremes;

/// What is to be found out about samples that are not recorded, fixed before the engine is built.
#[derive(Clone, Debug, Default)]
pub struct Wanted {
    /// Nets (1 bit) that must be 0 in every sample: otherwise there is no digest.
    pub never: Vec<Net>,
    /// Registers, and the bits to invert in each of their values, as [`Rows::extremes`](super::Rows::extremes) does.
    pub ranges: Vec<(Net, u64)>,
    /// Nets of which it is wanted in which samples they are not 0.
    pub trains: Vec<Net>,
    /// Numbers whose extremes are wanted.
    pub forms: Vec<Form>,
}

impl Wanted {
    /// Index of a train, which is added if it is not wanted yet.
    pub fn train(&mut self, net: Net) -> usize {
        self.trains.iter().position(|&other| other == net).unwrap_or_else(|| {
            self.trains.push(net);
            self.trains.len() - 1
        })
    }

    /// Index of a form, which is added if it is not wanted yet.
    pub fn form(&mut self, form: Form) -> usize {
        self.forms.iter().position(|other| *other == form).unwrap_or_else(|| {
            self.forms.push(form);
            self.forms.len() - 1
        })
    }

    /// Index of the range of a register, which is added if it is not wanted yet.
    pub fn range(&mut self, net: Net, turned: u64) -> usize {
        self.ranges.iter().position(|&other| other == (net, turned)).unwrap_or_else(|| {
            self.ranges.push((net, turned));
            self.ranges.len() - 1
        })
    }
}

/// `linear · v + square · v²`, v being the two's complement number of a net.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Term {
    /// The net.
    pub net: Net,
    /// Factor of its number.
    pub linear: i64,
    /// Factor of the square of its number.
    pub square: i64,
}

/// A sum of terms that stays within ±2^62, whatever the values of the nets.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Form(Vec<Term>);

impl Form {
    /// The form of these terms; `None` where it might leave ±2^62.
    #[must_use]
    pub fn new(netlist: &Netlist, terms: Vec<Term>) -> Option<Form> {
        let bound = terms.iter().try_fold(0u128, |sum, term| {
            let most = 1u128 << (netlist.width(term.net).get() - 1);
            let linear = u128::from(term.linear.unsigned_abs()).checked_mul(most)?;
            let square = u128::from(term.square.unsigned_abs()).checked_mul(most.checked_mul(most)?)?;
            sum.checked_add(linear)?.checked_add(square)
        })?;
        (bound <= 1 << 62).then_some(Form(terms))
    }

    /// Its terms.
    #[must_use]
    pub fn terms(&self) -> &[Term] {
        &self.0
    }
}

/// What the samples after the present one came to, for everything [`Wanted`], in that order.
#[derive(Clone, Debug, Default)]
pub struct Digest {
    /// Clock of the first of them.
    pub first_clock: u64,
    /// How many they are.
    pub clocks: u64,
    /// How many of them each word of a train stands for, at most 64.
    pub span: usize,
    /// Extremes of registers. They may include the sample before the first.
    pub ranges: Vec<Extremes>,
    /// A bit for each sample, the first the lowest of the first word: 1 where the net is not 0.
    pub trains: Vec<Vec<u64>>,
    /// The least and the greatest value of each form. They may leave out samples in which no net of the form has another
    /// value than in the sample before.
    pub forms: Vec<[i64; 2]>,
}
