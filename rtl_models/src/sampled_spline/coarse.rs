//! The coarse stage as hardware: registers and the table of its states.

use stepwave_netlist::Width;
use stepwave_netlist::dsl::{Memory, Register, Scope, Signal};

use super::recurrence::chord_limit;
use super::{DEGREE, DU, END, LAST_SPAN, P_XY, PLACE_FRACTION, Widths, chosen};
use crate::hardware::Hardware;
use crate::parts::Task::{Start, Wait};
use crate::parts::{
    Block, DISPLACEMENT, Long, LongRegister, Microprogram, Row, divide, magnitude, multiply, row, square_root, states,
    with_sign,
};

states! { mod at {
    IDLE = 0, SEEK = 1, FETCH = 2, ALPHA = 3, BLEND_X = 4, BLEND_Y = 5, BLEND_W = 6, POINT_X = 7, POINT_Y = 8,
    SPEED_X = 9, SPEED_Y = 10, SQUARE_X = 11, SQUARE_Y = 12, ROOT = 13, SCALE_W = 14, SCALE_U = 15, STEP = 16,
    CHORD_X = 17, CHORD_Y = 18, HAND_OVER = 19
} }

/// Bits of the register `state`.
pub(super) const STATE_BITS: u32 = 5;

/// Which point is calculated: that of the start, of the middle of the period's parameters, or of the period's end.
const START: u64 = 0;
const MIDDLE: u64 = 1;
const FAR: u64 = 2;

/// The registers of the coarse stage.
///
/// - `from_u`, `du`: where the period begins, and its step. `span`: the span of `from_u`. `end_u`, `last_span`: of the curve.
/// - `goal`, 2 bits: 0 start, 1 middle, 2 end of the period. `k`: the span of the point that is calculated. `j`, `r`: place and
///   level of de Boor.
/// - `hx0`, `hy0`, `hw0`, …: d_0 to d_p; `before_x`, `before_y`, `before_w`: d_p in front of the last level.
/// - `alpha`, 33 bits: share of d_j in 2^-32.
/// - `px`, `py`: the point; `start_x`, `middle_x`, …: those of the period.
/// - `speed_x`, `speed_y`: |N|; `square`: a sum of two squares; `scaled`: f·w.
#[derive(Clone)]
pub(super) struct Coarse<'m> {
    m: Scope<'m>,
    degree: u64,
    fraction: u32,
    widths: Widths,
    limit: u128,
    memories: [Memory<'m>; 4],
    program: Microprogram<'m>,
    f: Signal<'m>,
    end: Signal<'m>,
    last_span: Signal<'m>,
    from: Register<'m>,
    step: Register<'m>,
    span: Register<'m>,
    goal: Register<'m>,
    k: Register<'m>,
    j: Register<'m>,
    r: Register<'m>,
    /// By axis.
    d: [Vec<Register<'m>>; 3],
    before: [Register<'m>; 3],
    alpha: Register<'m>,
    point: [Register<'m>; 2],
    start: [Register<'m>; 2],
    middle: [Register<'m>; 2],
    speed: [LongRegister<'m>; 2],
    square: LongRegister<'m>,
    scaled: LongRegister<'m>,
}

const AXES: [&str; 3] = ["x", "y", "w"];

impl<'m> Coarse<'m> {
    pub(super) fn new(
        m: Scope<'m>,
        block: &Block<'m>,
        hardware: &Hardware,
        widths: Widths,
        memories: [Memory<'m>; 4],
    ) -> Coarse<'m> {
        let (fraction, tolerance) = hardware.sampling.map_or((0, crate::Millionths(0)), |s| (s.fraction, s.tolerance));
        let degree = u64::try_from(hardware.constant(DEGREE)).unwrap_or(1);
        let spans = super::address_bits(u32::try_from(hardware.constant(super::KNOTS)).unwrap_or(1));
        let program =
            Microprogram::of_states(m, STATE_BITS, widths.factors(), widths.division(fraction), widths.root());
        let [place, point] = [widths.place, widths.point];
        let of_axis = |axis: usize, name: &str| match axis {
            2 => m.reg(name, widths.weight),
            _ => m.reg_signed(name, widths.homogeneous),
        };
        let points = |name: &str| ["x", "y"].map(|axis| m.reg_signed(&format!("{name}_{axis}"), point));
        let levels = Width::needed_unsigned(degree.into());
        Coarse {
            m,
            degree,
            fraction,
            widths,
            limit: chord_limit(tolerance, fraction, widths.chord),
            memories,
            program,
            f: block.held(m, DISPLACEMENT.name(), widths.word),
            end: block.held(m, END, place),
            last_span: block.held(m, LAST_SPAN, spans),
            from: m.reg("from_u", place),
            step: m.reg(DU.name(), place),
            span: m.reg("span", spans),
            goal: m.reg("goal", 2),
            k: m.reg("k", spans),
            j: m.reg("j", levels),
            r: m.reg("r", levels),
            d: [0, 1, 2]
                .map(|axis| (0..=degree).map(|index| of_axis(axis, &format!("h{}{index}", AXES[axis]))).collect()),
            before: [0, 1, 2].map(|axis| of_axis(axis, &format!("before_{}", AXES[axis]))),
            alpha: m.reg("alpha", PLACE_FRACTION + 1),
            point: [0, 1].map(|axis| m.reg_signed(P_XY.of(axis).name(), point)),
            start: points("start"),
            middle: points("middle"),
            speed: ["speed_x", "speed_y"].map(|name| LongRegister::new(m, name, widths.speed)),
            square: LongRegister::new(m, "square", 2 * widths.root()),
            scaled: LongRegister::new(m, "scaled", widths.word + widths.weight),
        }
    }

    fn lit(&self, like: Register<'m>, value: u64) -> Signal<'m> {
        self.m.lit(like.q.bits(), value)
    }

    fn goal_is(&self, goal: u64) -> Signal<'m> {
        self.goal.q.equals(self.lit(self.goal, goal))
    }

    /// Half of the step, rounded down.
    fn half(&self) -> Signal<'m> {
        let bits = self.widths.place;
        self.step.q.slice(1, bits - 1).extend(bits)
    }

    /// Closes it: it begins at an edge with `runs` = 1 (1 bit), and hands over where the fine stage is `free` (1 bit). Returns
    /// `hand` and `last` of the fine stage, u of the point that is handed over, and the point.
    pub(super) fn close(
        self,
        runs: Signal<'m>,
        free: Signal<'m>,
    ) -> (Signal<'m>, Signal<'m>, Signal<'m>, [Signal<'m>; 2]) {
        let m = self.m;
        let offset = self.goal_is(MIDDLE).mux(self.half(), self.step.q);
        let place = m.name("place", self.from.q.wrapping_add(offset));
        let arrives = m.name("arrives", place.equals(self.end));
        let hand = m.name("hand", self.program.at(at::HAND_OVER) & free);

        let p = self.degree;
        let zero = |register: Register<'m>| (register, self.lit(register, 0));
        let begins = [
            zero(self.from),
            zero(self.step),
            (self.goal, self.lit(self.goal, START)),
            (self.span, self.lit(self.span, p)),
            (self.k, self.lit(self.k, p)),
            (self.j, self.lit(self.j, p)),
            (self.r, self.lit(self.r, p)),
        ];
        let handed = [
            (self.from, place),
            (self.span, self.k.q),
            (self.start[0], self.point[0].q),
            (self.start[1], self.point[1].q),
        ];
        let rows = [
            vec![row(at::IDLE, Start(runs), begins, at::SEEK)],
            self.evaluation(place),
            self.points(),
            self.speeds(),
            self.steps(),
            self.chords(),
            vec![row(at::HAND_OVER, Wait(free), handed, at::SPEED_X).unless(arrives, at::IDLE)],
        ];
        self.program.close(&rows.concat());
        (hand, arrives, place, self.point.map(|point| point.q))
    }

    /// The span of a place, its control points, and de Boor's levels.
    fn evaluation(&self, place: Signal<'m>) -> Vec<Row<'m>> {
        let (m, bits, p) = (self.m, self.k.q.bits(), self.degree);
        let [j, r] = [self.j, self.r].map(|register| register.q.extend(bits));
        let low_at = self.k.q.wrapping_add(j).wrapping_sub(m.lit(bits, p));
        let high_at = self.k.q.wrapping_add(j).wrapping_sub(r).wrapping_add(m.lit(bits, 1));
        let [wx, wy, w, knots] = self.memories;
        let low = m.name("knot_low", knots.read(low_at));
        let high = m.name("knot_high", knots.read(high_at));
        let always = m.lit(1, 1);

        // While j and r are p, the upper knot is the end of the span.
        let further = m.name("further", !place.less_than(high) & self.k.q.less_than(self.last_span));
        let next_k = self.k.q.wrapping_add(m.lit(bits, 1));
        let at_p = self.j.q.equals(self.lit(self.j, p));
        let up = self.j.q.wrapping_add(self.lit(self.j, 1));
        let seek = [(self.k, further.mux(next_k, self.k.q)), (self.j, further.mux(self.j.q, self.lit(self.j, 0)))];
        let fetch = [(self.j, at_p.mux(self.j.q, up)), (self.r, self.lit(self.r, 1))];
        let words = [wx, wy, w].map(|memory| memory.read(low_at));
        let fetched = (0..3).flat_map(|axis| self.at_place(axis, words[axis]));

        let ends_level = self.j.q.equals(self.r.q);
        let all = m.name("all_levels", ends_level & self.r.q.equals(self.lit(self.r, p)));
        let down = self.j.q.wrapping_sub(self.lit(self.j, 1));
        let deeper = self.r.q.wrapping_add(self.lit(self.r, 1));
        let turn =
            [(self.j, ends_level.mux(self.lit(self.j, p), down)), (self.r, (ends_level & !all).mux(deeper, self.r.q))];
        let share = Long::from(place.wrapping_sub(low)).concat(m.lit(PLACE_FRACTION, 0));
        let alpha = self.program.divider.long_quotient().slice(0, PLACE_FRACTION + 1).net();
        let before = [0, 1, 2].map(|axis| (self.before[axis], self.d[axis][self.d[axis].len() - 1].q));
        let [(x, to_x), (y, to_y), (w, to_w)] = [0, 1, 2].map(|axis| self.blend(axis));
        vec![
            row(at::SEEK, Wait(always), seek, at::SEEK).unless(!further, at::FETCH),
            row(at::FETCH, Wait(always), fetch, at::FETCH).taking(fetched).unless(at_p, at::ALPHA),
            row(at::ALPHA, divide(share, high.wrapping_sub(low)), [(self.alpha, alpha)], at::BLEND_X),
            row(at::BLEND_X, multiply(x, self.alpha.q), [], at::BLEND_Y).taking(to_x).keeping(before),
            row(at::BLEND_Y, multiply(y, self.alpha.q), [], at::BLEND_W).taking(to_y),
            row(at::BLEND_W, multiply(w, self.alpha.q), turn, at::ALPHA).taking(to_w).unless(all, at::POINT_X),
        ]
    }

    /// The writes by which d_j of an axis becomes a value.
    fn at_place(&self, axis: usize, value: Signal<'m>) -> Vec<(Register<'m>, Signal<'m>)> {
        let of = |(index, &register): (usize, &Register<'m>)| {
            // At most the degree.
            let here = self.j.q.equals(self.lit(self.j, index as u64));
            (register, here.mux(value, register.q))
        };
        self.d[axis].iter().enumerate().map(of).collect()
    }

    /// |d_j - d_(j-1)| of an axis, and the writes of d_(j-1) + (d_j - d_(j-1))·α by the product.
    fn blend(&self, axis: usize) -> (Signal<'m>, Vec<(Register<'m>, Signal<'m>)>) {
        let m = self.m;
        let one_less = self.j.q.wrapping_sub(self.lit(self.j, 1));
        let [own, other] = [self.j.q, one_less].map(|index| chosen(m, &self.d[axis], index));
        let bits = own.bits();
        let difference = own.extend(bits + 1).as_signed().wrapping_sub(other.extend(bits + 1).as_signed());
        let negative = difference.msb();
        let size = magnitude(m, difference).slice(0, bits);

        // Halves upwards: of a negative difference halves of the product go down.
        let product = self.program.multiplier.long_product().slice(0, bits + PLACE_FRACTION + 1);
        let half = 1_u128 << (PLACE_FRACTION - 1);
        let [half, less] = [half, half - 1].map(|value| Long::constant(m, product.bits(), value));
        let (_, sum) = product.carrying_add(Long::select(negative, less, half));
        let moved = sum.slice(PLACE_FRACTION, bits).net().extend(bits + 1).as_signed();
        let other = other.extend(bits + 1).as_signed();
        let value = negative.mux(other.wrapping_sub(moved), other.wrapping_add(moved)).slice(0, bits);
        (size, self.at_place(axis, value))
    }

    /// d_p of an axis.
    fn last(&self, axis: usize) -> Signal<'m> {
        self.d[axis][self.d[axis].len() - 1].q
    }

    /// The point, and what it is for.
    fn points(&self) -> Vec<Row<'m>> {
        let (m, bits) = (self.m, self.widths.point);
        let weight = self.last(2);
        let divider = self.program.divider;
        let whole = divider.long_quotient().slice(0, bits - 1).net();
        let rest = divider.remainder().slice(0, weight.bits());
        let (twice, weight_wide) = (rest.concat(m.lit(1, 0)), weight.extend(weight.bits() + 1));
        let [size_x, size_y] = [0, 1].map(|axis| magnitude(m, self.last(axis)));
        // Halves upwards.
        let rounded = |axis: usize| {
            let negative = self.last(axis).msb();
            let up = negative.mux(weight_wide.less_than(twice), !twice.less_than(weight_wide));
            with_sign(m, whole.wrapping_add(up.extend(bits - 1)), bits, negative)
        };
        let dividend = |size: Signal<'m>| Long::from(size).concat(m.lit(self.fraction, 0));
        let (start, middle) = (self.goal_is(START), self.goal_is(MIDDLE));
        let now = [self.point[0].q, rounded(1)];
        let kept = [(self.start, start), (self.middle, middle)]
            .map(|(registers, here)| [0, 1].map(|axis| (registers[axis], here.mux(now[axis], registers[axis].q))));
        let on = [
            (self.point[1], now[1]),
            (self.goal, middle.mux(self.lit(self.goal, FAR), self.goal.q)),
            (self.span, start.mux(self.k.q, self.span.q)),
            (self.k, middle.mux(self.span.q, self.k.q)),
        ];
        vec![
            row(at::POINT_X, divide(dividend(size_x), weight), [(self.point[0], rounded(0))], at::POINT_Y),
            row(at::POINT_Y, divide(dividend(size_y), weight), on, at::CHORD_X)
                .taking(kept.concat())
                .unless(start, at::SPEED_X)
                .unless(middle, at::SEEK),
        ]
    }

    /// |N| of both axes, and its root.
    fn speeds(&self) -> Vec<Row<'m>> {
        let (m, bits) = (self.m, self.widths.speed);
        let p = self.degree;
        let g = [0, 1, 2].map(|axis| {
            let low = self.d[axis][self.d[axis].len() - 2].q;
            let wide = low.bits() + 4;
            let [high, low] = [self.before[axis].q, low].map(|value| value.extend(wide).as_signed());
            m.name(&format!("g_{}", AXES[axis]), high.wrapping_sub(low).wrapping_mul(m.lit(wide, p)).as_signed())
        });
        let weight = magnitude(m, g[2]);
        let product = self.program.multiplier.long_product().slice(0, bits);
        let of_axis = |axis: usize| {
            let scaled = Long::from(magnitude(m, g[axis])).concat(m.lit(self.fraction, 0)).extend(m, bits);
            // Of unlike signs both add up.
            let unlike = g[axis].msb() ^ g[2].msb() ^ self.point[axis].q.msb();
            let (borrow, difference) = scaled.borrowing_sub(product);
            let (_, sum) = scaled.carrying_add(product);
            Long::select(unlike, sum, difference.negated_if(m, borrow))
        };
        let takes = [0, 1].map(|axis| self.speed[axis].takes(of_axis(axis)));
        let [x, y] = self.point.map(|point| magnitude(m, point.q));
        let [speed_x, speed_y] = self.speed.map(|speed| speed.q);
        let square = self.program.multiplier.long_product().slice(0, 2 * bits).extend(m, self.square.q.bits());
        let (_, sum) = self.square.q.carrying_add(square);
        let [to_x, to_y] = takes;
        vec![
            row(at::SPEED_X, multiply(x, weight), [], at::SPEED_Y).taking(to_x),
            row(at::SPEED_Y, multiply(y, weight), [], at::SQUARE_X).taking(to_y),
            row(at::SQUARE_X, multiply(speed_x, speed_x), [], at::SQUARE_Y).taking(self.square.takes(square)),
            row(at::SQUARE_Y, multiply(speed_y, speed_y), [], at::ROOT).taking(self.square.takes(sum)),
            row(at::ROOT, square_root(self.square.q), [], at::SCALE_W),
        ]
    }

    /// Δu = f·w·(U_(k+1) - U_k) / |N|.
    fn steps(&self) -> Vec<Row<'m>> {
        let (m, place) = (self.m, self.widths.place);
        let bits = self.scaled.q.bits();
        let [low_at, high_at] =
            [m.lit(self.k.q.bits(), 0), m.lit(self.k.q.bits(), 1)].map(|more| self.k.q.wrapping_add(more));
        let knots = self.memories[3];
        let span = m.name("span_length", knots.read(high_at).wrapping_sub(knots.read(low_at)));
        let product = self.program.multiplier.long_product();
        let quotient = self.program.divider.long_quotient();
        let rest = self.end.wrapping_sub(self.from.q);
        let low = quotient.slice(0, place).net();
        let above = quotient.slice(place, quotient.bits() - place);
        let beyond = Long::zero(m, above.bits()).less_than(above) | rest.less_than(low);
        let least = low.is_zero().mux(m.lit(place, 1), low);
        let found =
            [(self.step, beyond.mux(rest, least)), (self.goal, self.lit(self.goal, MIDDLE)), (self.k, self.span.q)];
        let dividend = product.slice(0, bits + place);
        vec![
            row(at::SCALE_W, multiply(self.f, self.last(2)), [], at::SCALE_U)
                .taking(self.scaled.takes(product.slice(0, bits))),
            row(at::SCALE_U, multiply(self.scaled.q, span), [], at::STEP),
            row(at::STEP, divide(dividend, self.program.root.long_root()), found, at::SEEK),
        ]
    }

    /// Twice the distance from the middle of the chord to the curve, squared, against the tolerance.
    fn chords(&self) -> Vec<Row<'m>> {
        let (m, bits) = (self.m, self.widths.chord);
        let [x, y] = [0, 1].map(|axis| {
            let [middle, start, end] =
                [self.middle, self.start, self.point].map(|registers| registers[axis].q.extend(bits + 1).as_signed());
            let twice = middle.slice(0, bits).concat(m.lit(1, 0)).as_signed();
            magnitude(m, twice.wrapping_sub(start).wrapping_sub(end)).slice(0, bits)
        });
        let product = self.program.multiplier.long_product().slice(0, 2 * bits);
        let wide = self.square.q.bits();
        let square = product.extend(m, wide);
        let (_, sum) = self.square.q.carrying_add(square);
        let one = self.step.q.equals(m.lit(self.widths.place, 1));
        let far = m.name("far", Long::constant(m, wide, self.limit).less_than(sum) & !one);
        let again = [
            (self.step, far.mux(self.half(), self.step.q)),
            (self.goal, far.mux(self.lit(self.goal, MIDDLE), self.goal.q)),
            (self.k, far.mux(self.span.q, self.k.q)),
        ];
        vec![
            row(at::CHORD_X, multiply(x, x), [], at::CHORD_Y).taking(self.square.takes(square)),
            row(at::CHORD_Y, multiply(y, y), again, at::HAND_OVER).unless(far, at::SEEK),
        ]
    }
}
