//! The ends of a curve in the plane, in machine coordinates and relative to its centre.

/// Gives a curve with the fields `from`, `to` and `center` their getters; the text says what its centre is.
macro_rules! ends {
    ($curve:ident, $center:literal) => {
        impl $curve {
            /// The start point in machine coordinates, in BLU.
            #[must_use]
            pub fn from(&self) -> [i64; 2] {
                self.from
            }

            /// The end point in machine coordinates, in BLU.
            #[must_use]
            pub fn to(&self) -> [i64; 2] {
                self.to
            }

            #[doc = concat!("The ", $center, ", in machine coordinates, in BLU.")]
            #[must_use]
            pub fn center(&self) -> [i64; 2] {
                self.center
            }

            #[doc = concat!("The start point relative to the ", $center, ", in BLU.")]
            #[must_use]
            pub fn start(&self) -> [i64; 2] {
                self.relative(self.from)
            }

            #[doc = concat!("The end point relative to the ", $center, ", in BLU.")]
            #[must_use]
            pub fn end(&self) -> [i64; 2] {
                self.relative(self.to)
            }

            fn relative(&self, [x, y]: [i64; 2]) -> [i64; 2] {
                [x - self.center[0], y - self.center[1]]
            }
        }
    };
}
pub(crate) use ends;
