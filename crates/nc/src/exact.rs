//! Exact integer arithmetic on plane vectors and square roots.
//!
//! Bounds: a coordinate of a block is at most 2^52, so a difference of two is at most 2^53, and the square of a radius
//! at most 2^107. A position that hardware reports may be any `i64`; relative to a block it is less than 2^63 + 2^53,
//! so its squared length is less than 2^128 and fits `u128`, and its cross product with a difference fits `i128`.

/// A vector in the plane, in BLU.
pub(crate) type Vector = [i128; 2];

/// The vector of two coordinates.
pub(crate) fn vector(point: [i64; 2]) -> Vector {
    point.map(i128::from)
}

/// The vector from `origin` to `point`; never overflows.
pub(crate) fn between(origin: [i64; 2], point: [i64; 2]) -> Vector {
    let ([x0, y0], [x, y]) = (vector(origin), vector(point));
    [x - x0, y - y0]
}

/// The squared length, in BLU².
pub(crate) fn norm_squared([x, y]: Vector) -> u128 {
    x.unsigned_abs().pow(2) + y.unsigned_abs().pow(2)
}

/// The cross product: positive if `b` points to the left of `a`.
pub(crate) fn cross(a: Vector, b: Vector) -> i128 {
    a[0] * b[1] - a[1] * b[0]
}

/// The scalar product.
pub(crate) fn dot(a: Vector, b: Vector) -> i128 {
    a[0] * b[0] + a[1] * b[1]
}

/// The least integer that is not below the square root.
pub(crate) fn ceil_sqrt(square: u128) -> u128 {
    let floor = square.isqrt();
    if floor * floor < square { floor + 1 } else { floor }
}

/// The integer nearest to the square root; there is no tie, as (r + ½)² is never an integer.
pub(crate) fn round_sqrt(square: u128) -> u128 {
    let floor = square.isqrt();
    if square - floor * floor > floor { floor + 1 } else { floor }
}

/// Whether the square roots of `a` and `b` differ by at most one.
pub(crate) fn roots_within_one(a: u128, b: u128) -> bool {
    // √a ≤ √b + 1 (a the larger) ⟺ a - b - 1 ≤ 2√b, and the left side is an integer.
    a.abs_diff(b) <= 1 + (4 * a.min(b)).isqrt()
}

/// A length as `i64`; saturates, which no radius of a block comes near to.
pub(crate) fn length(value: u128) -> i64 {
    i64::try_from(value).unwrap_or(i64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_round_up_and_to_nearest_exactly() {
        let up: Vec<u128> = (0..=10).map(ceil_sqrt).collect();
        assert_eq!(up, [0, 1, 2, 2, 2, 3, 3, 3, 3, 3, 4]);
        let nearest: Vec<u128> = (0..=13).map(round_sqrt).collect();
        assert_eq!(nearest, [0, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 3, 3, 4]);
        let r = 1_u128 << 53;
        assert_eq!(ceil_sqrt(r * r), r);
        assert_eq!(ceil_sqrt(r * r + 1), r + 1);
        assert_eq!(round_sqrt(r * r + r), r);
        assert_eq!(round_sqrt(r * r + r + 1), r + 1);
    }

    #[test]
    fn the_comparison_of_roots_agrees_with_their_values() {
        for a in 0..2_000_u32 {
            for b in 0..=a {
                let gap = f64::from(a).sqrt() - f64::from(b).sqrt();
                // Where the gap is exactly one, both are squares of integers, whose roots f64 gives
                // exactly.
                assert_eq!(roots_within_one(a.into(), b.into()), gap <= 1.0, "√{a} - √{b} = {gap}");
                assert_eq!(roots_within_one(b.into(), a.into()), gap <= 1.0, "√{b} - √{a} = {gap}");
            }
        }
    }

    #[test]
    fn the_farthest_position_does_not_overflow() {
        let corner = [-crate::COORDINATE_LIMIT; 2];
        let away = between(corner, [i64::MAX; 2]);
        assert!(norm_squared(away) > 1 << 127);
        assert_eq!(cross(away, away), 0);
    }
}
