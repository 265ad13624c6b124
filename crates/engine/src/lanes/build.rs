//! Puts values into an order and into rows: dead ones are dropped, and a row is used again when its value was read for
//! the last time, so that the working set stays small.

use rustc_hash::FxHashMap as HashMap;

use super::code::{Code, LaneOp, Operation, PortRows, RegisterRow, Slot};
use super::lower::{Lowering, Node, Value};
use super::watch::Reduce;
use stepwave_netlist::cells::{Net, Netlist, Op, WritePort};

/// What a machine is to compute; all nets are of `netlist`.
pub(super) struct LaneRequest<'a> {
    /// A netlist as `passes::simplify` gives it.
    pub(super) netlist: &'a Netlist,
    /// Its inputs; one that is fixed is a constant here.
    pub(super) inputs: &'a [Net],
    /// The registers that it has, whether it needs them or not.
    pub(super) registers: &'a [Net],
    /// The memories that it has, by index.
    pub(super) memories: &'a [usize],
    /// The accumulators: how, and of which nets.
    pub(super) accumulators: &'a [(Reduce, Vec<Net>)],
    /// Nets to be seen in each sample.
    pub(super) outputs: &'a [Net],
    /// Nets of which an extra output, after the others, says whether one is 1.
    pub(super) any: &'a [Net],
}

impl LaneRequest<'_> {
    /// The code.
    pub(super) fn build(&self) -> Code {
        let mut lowering = Lowering::new(self.netlist);
        let registers: Vec<Value> = self.registers.iter().map(|&net| lowering.net(net)).collect();
        let mut outputs: Vec<Value> = self.outputs.iter().map(|&net| lowering.net(net)).collect();
        if !self.any.is_empty() {
            let values: Vec<Value> = self.any.iter().map(|&net| lowering.net(net)).collect();
            outputs.push(lowering.any(values));
        }
        let next: Vec<Option<Value>> =
            self.registers.iter().zip(&registers).map(|(&net, &own)| self.next(&mut lowering, net, own)).collect();
        let ports = self.ports(&mut lowering);
        let written: Vec<Value> = ports.iter().flat_map(Port::values).collect();
        let next = unshare(&mut lowering, next, &[&outputs[..], &written].concat());
        let accumulators: Vec<(Value, LaneOp<Value>)> = self
            .accumulators
            .iter()
            .enumerate()
            .map(|(index, (reduce, nets))| accumulate(&mut lowering, index, *reduce, nets))
            .collect();
        let roots = next.iter().flatten().chain(&outputs).chain(&written).copied();
        let mut rows = Rows::new(&lowering, roots.collect(), &accumulators);
        let mut code = Code::default();
        let leaves: Vec<Value> = registers.iter().copied().chain(accumulators.iter().map(|(own, _)| *own)).collect();
        leaves.iter().for_each(|&leaf| _ = rows.keep(leaf));
        for (index, node) in lowering.nodes.iter().enumerate() {
            let value = Value(index);
            match *node {
                _ if !rows.is_live(value) => {}
                Node::Constant(pattern) => code.constants.push((rows.keep(value), pattern)),
                Node::Input(net) => {
                    let row = rows.keep(value);
                    code.inputs.extend(self.inputs.iter().position(|&input| input == net).map(|index| (index, row)));
                }
                Node::Register(_) | Node::Accumulator(_) => {}
                Node::Operation(what) => {
                    let operation = rows.place(value, what);
                    code.operations.push(operation);
                }
            }
        }
        code.observers = code.operations.len();
        for (own, what) in accumulators {
            let target = rows.of(own);
            code.operations.push(Operation { target, what: what.map(|value| rows.of(value)) });
            code.accumulators.push(target);
        }
        code.outputs = outputs.iter().map(|&value| rows.of(value)).collect();
        for ((&net, own), next) in self.registers.iter().zip(registers).zip(next) {
            let cell = self.netlist.cell(net);
            if let Op::Register { reset, .. } = cell.op {
                let next = next.map(|value| rows.of(value));
                code.registers.push(RegisterRow { width: cell.width, reset, row: rows.of(own), next });
            }
        }
        code.writes = ports.iter().map(|port| port.rows(&rows)).collect();
        code.rows = rows.count;
        code
    }

    /// The ports of the memories, with values that an edge leaves where they are.
    fn ports(&self, lowering: &mut Lowering) -> Vec<Port> {
        let ports = self
            .memories
            .iter()
            .flat_map(|&memory| self.netlist.memories[memory].writes.iter().map(move |port| (memory, *port)));
        let mut stay = |net: Net| {
            let value = lowering.net(net);
            match lowering.nodes[value.0] {
                Node::Register(_) => lowering.unshared(Node::Operation(LaneOp::Copy(value))),
                _ => value,
            }
        };
        let port = |(memory, WritePort { enable, address, data, mask }): (usize, WritePort)| Port {
            memory,
            enable: stay(enable),
            address: stay(address),
            bits: self.netlist.width(address).get(),
            data: stay(data),
            mask: mask.map(&mut stay),
        };
        ports.map(port).collect()
    }

    /// The next value of a register, unless it keeps its own.
    fn next(&self, lowering: &mut Lowering, register: Net, own: Value) -> Option<Value> {
        let Op::Register { next: Some(next), .. } = self.netlist.cell(register).op else { return None };
        let next = lowering.net(next);
        (next != own).then_some(next)
    }
}

/// A port of a memory while code is built.
struct Port {
    memory: usize,
    enable: Value,
    address: Value,
    bits: u32,
    data: Value,
    mask: Option<Value>,
}

impl Port {
    fn values(&self) -> Vec<Value> {
        [Some(self.enable), Some(self.address), Some(self.data), self.mask].into_iter().flatten().collect()
    }

    fn rows(&self, rows: &Rows) -> PortRows {
        let Port { memory, bits, .. } = *self;
        let [enable, address, data] = [self.enable, self.address, self.data].map(|value| rows.of(value));
        PortRows { memory, enable, address, bits, data, mask: self.mask.map(|mask| rows.of(mask)) }
    }
}

/// Gives every next value a row of its own, so that an edge is an exchange of rows.
fn unshare(lowering: &mut Lowering, next: Vec<Option<Value>>, outputs: &[Value]) -> Vec<Option<Value>> {
    let mut taken: Vec<Value> = outputs.to_vec();
    let mut own = |value: Value| {
        if matches!(lowering.nodes[value.0], Node::Operation(_)) && !taken.contains(&value) {
            taken.push(value);
            value
        } else {
            lowering.unshared(Node::Operation(LaneOp::Copy(value)))
        }
    };
    next.into_iter().map(|value| value.map(&mut own)).collect()
}

/// The row of an accumulator and the operation that updates it.
fn accumulate(lowering: &mut Lowering, index: usize, reduce: Reduce, nets: &[Net]) -> (Value, LaneOp<Value>) {
    let own = lowering.leaf(Node::Accumulator(index));
    let what = match reduce {
        Reduce::Count => {
            let any = lowering.any_set(nets);
            LaneOp::Count(own, any)
        }
        Reduce::Idle => {
            let half = nets.len() / 2;
            let (a, b) = (lowering.any_set(&nets[..half]), lowering.any_set(&nets[half..]));
            LaneOp::Idle(own, a, b)
        }
        Reduce::Least { signed } | Reduce::Greatest { signed } => {
            let value = lowering.net(nets[0]);
            match (reduce, signed) {
                (Reduce::Least { .. }, false) => LaneOp::Least(own, value),
                (Reduce::Least { .. }, true) => LaneOp::LeastSigned(own, value),
                (_, false) => LaneOp::Greatest(own, value),
                (_, true) => LaneOp::GreatestSigned(own, value),
            }
        }
        Reduce::Sum => {
            let [(value, bits)] = numbers(lowering, [nets[0]]);
            LaneOp::Sum(own, value, bits)
        }
        Reduce::RootGaps => LaneOp::RootGaps(own, numbers(lowering, [nets[0], nets[1]])),
        Reduce::LeastGap { since } | Reduce::GreatestGap { since } => {
            let (since, at) = (lowering.leaf(Node::Accumulator(since)), lowering.net(nets[0]));
            match reduce {
                Reduce::LeastGap { .. } => LaneOp::LeastWhere(own, since, at),
                _ => LaneOp::GreatestWhere(own, since, at),
            }
        }
        Reduce::Since => LaneOp::Since(own, lowering.net(nets[0])),
    };
    (own, what)
}

/// The values of nets, each with its number of bits.
fn numbers<const N: usize>(lowering: &mut Lowering, nets: [Net; N]) -> [(Value, u32); N] {
    nets.map(|net| (lowering.net(net), lowering.width(net).get()))
}

/// Which value is in which row, and until when.
struct Rows {
    last_use: Vec<Option<usize>>,
    row: HashMap<Value, Slot>,
    free: Vec<Slot>,
    count: usize,
}

/// A value that is still needed when all operations are done.
const END: usize = usize::MAX;

impl Rows {
    fn new(lowering: &Lowering, mut roots: Vec<Value>, accumulators: &[(Value, LaneOp<Value>)]) -> Rows {
        for (_, what) in accumulators {
            what.map(|value| roots.push(value));
        }
        let mut last_use = vec![None; lowering.nodes.len()];
        roots.iter().for_each(|root| last_use[root.0] = Some(END));
        // Operands come before their users, so that one walk from the end reaches all that is needed.
        for index in (0..lowering.nodes.len()).rev() {
            if let (Some(_), Node::Operation(what)) = (last_use[index], lowering.nodes[index]) {
                what.map(|operand| {
                    let last = &mut last_use[operand.0];
                    *last = Some(last.map_or(index, |last| last.max(index)));
                });
            }
        }
        Rows { last_use, row: HashMap::default(), free: Vec::new(), count: 0 }
    }

    fn is_live(&self, value: Value) -> bool {
        self.last_use[value.0].is_some()
    }

    fn of(&self, value: Value) -> Slot {
        self.row[&value]
    }

    /// A row for good.
    fn keep(&mut self, value: Value) -> Slot {
        self.last_use[value.0] = Some(END);
        *self.row.entry(value).or_insert_with(|| {
            self.count += 1;
            self.count - 1
        })
    }

    /// The operation with its rows. An operand read for the last time gives its row to the result.
    fn place(&mut self, value: Value, what: LaneOp<Value>) -> Operation {
        let mut ended = Vec::new();
        let what = what.map(|operand| {
            if self.last_use[operand.0] == Some(value.0) && !ended.contains(&operand) {
                ended.push(operand);
            }
            self.of(operand)
        });
        self.free.extend(ended.iter().map(|operand| self.row[operand]));
        let target = self.free.pop().unwrap_or_else(|| {
            self.count += 1;
            self.count - 1
        });
        self.row.insert(value, target);
        Operation { target, what }
    }
}
