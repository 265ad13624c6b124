//! Code generation: a loop that passes over the samples in which a machine is idle.
//!
//! Most clocks of a machine driven by a pulse source do no more than add to its phase. The inner loop computes nothing
//! but the running registers and whether anything else wakes; all other registers stay in it, so that all that depends
//! on them alone is computed outside.
//!
//! ```text
//! entry:  one edge from the sample that the caller holds
//! awake:  settle; record a row; leave at a stop net, with no room, or no clocks left; if all rests: idle, with the
//! edge of
//!         the running registers; otherwise: edge; awake
//! idle:   settle the running registers; if anything wakes: awake; extremes; leave if no clocks are left; edge; idle
//! ```
//!
//! The words of the state after registers and inputs: [`ROOM`] rows that fit, and on return those recorded; [`CLOCK`],
//! of the sample that the caller holds; four [`Extremes`](stepwave_netlist::Extremes) words of each running register,
//! of unsigned values passed over: the least, the greatest, bits that were 1 in any and in all of them.

use rustc_hash::FxHashMap;
use std::collections::BTreeSet;

use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{Block, BlockArg, InstBuilder, Value, types};
use cranelift_frontend::FunctionBuilder;

use super::codegen::{Generator, Plan, RegisterValues, kind, offset, trusted};
use stepwave_netlist::bits::Width;
use stepwave_netlist::cells::{Net, Netlist, Op};
use stepwave_netlist::passes::{Simplified, simplify};

/// Word of the room.
pub(super) const ROOM: usize = 0;
/// Word of the clock.
pub(super) const CLOCK: usize = 1;
/// Words in front of those of the running registers.
pub(super) const HEAD: usize = 2;
/// Words of a running register.
pub(super) const EXTREMES: usize = 4;

/// Words of the state after registers and inputs.
pub(super) fn words(plan: &Plan<'_>) -> usize {
    HEAD + EXTREMES * plan.running.len()
}

/// When a machine rests: no register but the running ones changes at the next edge.
struct Rest {
    /// Nets of the entry, 1 bit each, in the order of evaluation: one of them is 1 where a register that holds its
    /// value otherwise takes another.
    enables: Vec<Net>,
    /// The netlist while they are all 0.
    logic: Simplified,
    /// The other registers that may change then, and their next values; nets of `logic`.
    others: Vec<(Net, Net)>,
}

impl Rest {
    fn of(plan: &Plan<'_>) -> Rest {
        let entry = plan.entry;
        let registers = || plan.registers.iter().filter(|(net, _)| !plan.running.contains(net));
        let all = registers().flat_map(|&(net, next)| enables(&entry.netlist, entry.net(net), entry.net(next)));
        let enables: Vec<Net> = all.collect::<BTreeSet<_>>().into_iter().collect();
        let resting = simplify(&entry.netlist, &enables.iter().map(|&net| (net, 0)).collect::<FxHashMap<Net, u64>>());
        let map = entry.map.iter().map(|&net| resting.net(net)).collect();
        let logic = Simplified { map, netlist: resting.netlist };
        let others = registers().map(|&(net, next)| (logic.net(net), logic.net(next)));
        let others = others.filter(|(register, next)| register != next).collect();
        Rest { enables, logic, others }
    }
}

/// The conditions of the arms of a register that holds its value without them; none if it does not.
fn enables(netlist: &Netlist, register: Net, mut next: Net) -> Vec<Net> {
    let mut found = Vec::new();
    while next != register {
        match netlist.cell(next).op {
            Op::Mux { select, low, .. } => {
                found.push(select);
                next = low;
            }
            // What counts adds a condition.
            Op::Add(a, b) | Op::Sub(a, b) if a == register => match netlist.cell(b).op {
                Op::ZeroExtend(bit) if netlist.width(bit) == Width::ONE => {
                    found.push(bit);
                    break;
                }
                _ => return Vec::new(),
            },
            _ => return Vec::new(),
        }
    }
    found
}

/// Loop-carried values of both loops, other than the registers.
#[derive(Clone)]
struct Account {
    /// Clocks since the caller's sample.
    done: Value,
    /// Rows recorded.
    recorded: Value,
    /// Place of the next row in the first column.
    row: Value,
    /// Extremes of the running registers.
    extremes: Vec<Value>,
}

impl Account {
    fn values(&self) -> Vec<Value> {
        [self.done, self.recorded, self.row].into_iter().chain(self.extremes.iter().copied()).collect()
    }

    fn of(parameters: &[Value]) -> Account {
        let extremes = parameters[3..].to_vec();
        Account { done: parameters[0], recorded: parameters[1], row: parameters[2], extremes }
    }
}

struct Passing<'a, 'c> {
    generator: Generator<'a, 'c>,
    plan: &'a Plan<'a>,
    rest: Rest,
    /// Registers that change, by index, and the running ones among them.
    carried: Vec<usize>,
    running: Vec<usize>,
    clocks: Value,
    room: Value,
    clock: Value,
}

/// As [`codegen::generate`](super::codegen::generate), for one phase without fixed registers.
pub(super) fn generate(plan: &Plan<'_>, resting: &[usize], f: &mut FunctionBuilder<'_>, entry: Block) {
    let [state, rows, clocks, memories] = f.block_params(entry).to_vec()[..] else { return };
    let (mut generator, start) = Generator::begin(plan, resting, f, [state, memories]);
    let base = plan.registers.len() + plan.inputs.len();
    let [room, clock] = [ROOM, CLOCK].map(|word| generator.load(base + word, types::I64));
    let indices = 0..plan.registers.len();
    let carried: Vec<usize> = indices.filter(|&index| !plan.is_held(index)).collect();
    let place = |net: &Net| plan.registers.iter().position(|(register, _)| register == net);
    let running = plan.running.iter().filter_map(place).collect();
    let mut passing = Passing { generator, plan, rest: Rest::of(plan), carried, running, clocks, room, clock };
    passing.loops(rows, &start);
}

impl Passing<'_, '_> {
    fn loops(&mut self, rows: Value, start: &RegisterValues) {
        let plan = self.plan;
        let (carried, running) = (self.carried.clone(), self.running.clone());
        let values = self.generator.settle(plan.entry, start, &self.next());
        let first = self.generator.edge(plan.entry, &values, start);
        let [zero, one, ones] = [0, 1, -1].map(|number| self.generator.f.ins().iconst(types::I64, number));
        let extremes = self.running.iter().flat_map(|_| [ones, zero, zero, ones]).collect();
        let account = Account { done: one, recorded: zero, row: rows, extremes };
        let (awake, idle) = (self.block(&carried, &account), self.block(&running, &account));
        self.jump(awake, &carried, &first, &account);

        let (sample, account) = self.enter(awake, &carried, start);
        let observed = self.observed();
        let values = self.generator.settle(plan.entry, &sample, &observed);
        let clock = self.generator.f.ins().iadd(self.clock, account.done);
        let place = offset(plan.columns.len() * plan.stride);
        self.generator.f.ins().store(trusted(), clock, account.row, place);
        let row = self.generator.record(plan.entry, &values, account.row);
        let recorded = self.generator.f.ins().iadd_imm(account.recorded, 1);
        let account = Account { recorded, row, ..account };
        if let Some(stop) = self.generator.any_stop(plan.entry, &values) {
            self.leave_if(stop, &sample, &account);
        }
        let full = self.generator.f.ins().icmp(IntCC::Equal, recorded, self.room);
        self.leave_if(full, &sample, &account);
        self.leave_at_the_end(&sample, &account);
        let done = self.generator.f.ins().iadd_imm(account.done, 1);
        let account = Account { done, ..account };
        let flags: Vec<Net> = plan.flags.iter().chain(plan.stops).copied().collect();
        let woken = self.woken(&sample, &flags);
        let (edge, rest) = (self.generator.f.create_block(), self.generator.f.create_block());
        self.generator.f.ins().brif(woken, edge, &[], rest, &[]);
        self.generator.f.switch_to_block(edge);
        let next = self.generator.edge(plan.entry, &values, &sample);
        self.jump(awake, &carried, &next, &account);
        self.generator.f.switch_to_block(rest);
        let next = self.generator.next(plan.entry, &values, &sample);
        self.jump(idle, &running, &next, &account);

        // All registers but the running ones are those of the sample that was awake.
        let (sample, account) = self.enter(idle, &running, &sample);
        let woken = self.woken(&sample, &flags);
        let stay = self.generator.f.create_block();
        let arguments = self.arguments(&carried, &sample, &account);
        self.generator.f.ins().brif(woken, awake, &arguments, stay, &[]);
        self.generator.f.switch_to_block(stay);
        let account = Account { extremes: self.extremes(&sample, &account.extremes), ..account };
        self.leave_at_the_end(&sample, &account);
        let values = self.generator.settle(plan.entry, &sample, &self.next());
        // Nothing writes a memory here.
        let next = self.generator.next(plan.entry, &values, &sample);
        let done = self.generator.f.ins().iadd_imm(account.done, 1);
        self.jump(idle, &running, &next, &Account { done, ..account });
    }

    /// The nets of the next values.
    fn next(&self) -> Vec<Net> {
        self.plan.registers.iter().map(|&(_, next)| next).collect()
    }

    /// Everything that is looked at where the machine is awake.
    fn observed(&self) -> Vec<Net> {
        let mut nets = self.next();
        nets.extend(self.generator.busy.iter().map(|&column| self.plan.columns[column]));
        nets.extend(self.plan.stops);
        nets
    }

    /// 1 where a register but the running ones changes at the next edge, a memory is written, or one of `flags` is 1.
    fn woken(&mut self, sample: &RegisterValues, flags: &[Net]) -> Value {
        let logic = &self.rest.logic;
        let mut flags: Vec<Net> = flags.iter().map(|&net| logic.net(net)).collect();
        flags.extend(logic.netlist.memories.iter().flat_map(|memory| &memory.writes).map(|port| port.enable));
        let others = self.rest.others.iter().flat_map(|&(register, next)| [register, next]);
        let roots = flags.iter().copied().chain(others).collect();
        let values = self.generator.settle_roots(logic, sample, roots);
        // What stays while the machine is idle comes first, so that it is computed outside of that loop.
        let mut woken = self.generator.f.ins().iconst(types::I8, 0);
        for (register, next) in &self.rest.others {
            let changes = self.generator.f.ins().icmp(IntCC::NotEqual, values[register], values[next]);
            woken = self.generator.f.ins().bor(woken, changes);
        }
        for flag in flags {
            woken = self.generator.f.ins().bor(woken, values[&flag]);
        }
        for enable in self.enables(sample) {
            woken = self.generator.f.ins().bor(woken, enable);
        }
        woken
    }

    /// The enables, each as if all before it were 0: the first that is 1 is right, and one is enough.
    fn enables(&mut self, sample: &RegisterValues) -> Vec<Value> {
        let plan = self.plan;
        let mut found = Vec::new();
        self.generator.settle_each(plan.entry, sample, self.rest.enables.clone(), |f, net, value| {
            if self.rest.enables.binary_search(&net).is_err() {
                return value;
            }
            found.push(value);
            f.ins().iconst(types::I8, 0)
        });
        found
    }

    /// The extremes with those of a sample that is passed over.
    fn extremes(&mut self, sample: &RegisterValues, before: &[Value]) -> Vec<Value> {
        let mut extremes = Vec::with_capacity(before.len());
        for (place, &index) in self.running.iter().enumerate() {
            let value = self.generator.wide(sample[index]);
            let [least, greatest, any, all] = [0, 1, 2, 3].map(|word| before[place * EXTREMES + word]);
            let f = &mut self.generator.f;
            extremes.extend([
                f.ins().umin(least, value),
                f.ins().umax(greatest, value),
                f.ins().bor(any, value),
                f.ins().band(all, value),
            ]);
        }
        extremes
    }

    /// A block whose parameters are these registers and an account.
    fn block(&mut self, registers: &[usize], account: &Account) -> Block {
        let plan = self.plan;
        let f = &mut self.generator.f;
        let block = f.create_block();
        for &index in registers {
            let register = plan.entry.net(plan.registers[index].0);
            f.append_block_param(block, kind(plan.entry.netlist.width(register)));
        }
        for _ in account.values() {
            f.append_block_param(block, types::I64);
        }
        block
    }

    fn arguments(&self, registers: &[usize], sample: &RegisterValues, account: &Account) -> Vec<BlockArg> {
        registers.iter().map(|&index| sample[index]).chain(account.values()).map(BlockArg::from).collect()
    }

    fn jump(&mut self, block: Block, registers: &[usize], sample: &RegisterValues, account: &Account) {
        let arguments = self.arguments(registers, sample, account);
        self.generator.f.ins().jump(block, &arguments);
    }

    /// Continues in a block, with its parameters in the place of some registers.
    fn enter(&mut self, block: Block, registers: &[usize], others: &RegisterValues) -> (RegisterValues, Account) {
        self.generator.f.switch_to_block(block);
        let parameters = self.generator.f.block_params(block).to_vec();
        let mut sample = others.clone();
        for (&index, &value) in registers.iter().zip(&parameters) {
            sample[index] = value;
        }
        (sample, Account::of(&parameters[registers.len()..]))
    }

    fn leave_at_the_end(&mut self, sample: &RegisterValues, account: &Account) {
        let ended = self.generator.f.ins().icmp(IntCC::Equal, account.done, self.clocks);
        self.leave_if(ended, sample, account);
    }

    /// Where `condition` is not 0: writes registers and account back and returns the clocks done.
    fn leave_if(&mut self, condition: Value, sample: &RegisterValues, account: &Account) {
        let stay = self.generator.leaving(condition, sample);
        let words = self.plan.registers.len() + self.plan.inputs.len();
        self.generator.store_state(words + ROOM, account.recorded);
        for (word, &value) in account.extremes.iter().enumerate() {
            self.generator.store_state(words + HEAD + word, value);
        }
        self.generator.f.ins().return_(&[account.done]);
        self.generator.f.switch_to_block(stay);
    }
}
