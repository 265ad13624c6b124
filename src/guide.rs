//! Six small programs to read first. Each is a file of `examples/`, which the tests run.

macro_rules! page {
    ($(#[$about:meta])* $name:ident) => {
        $(#[$about])*
        ///
        /// ```rust,ignore
        #[doc = include_str!(concat!("../examples/", stringify!($name), ".rs"))]
        /// ```
        pub mod $name {}
    };
}

page!(
    /// The first wave: one run, its report, its step table, its wave for GTKWave.
    first_wave
);
page!(
    /// A method of one's own, with every command.
    own_model
);
page!(
    /// A netlist that is not an interpolator: an LFSR and a counter.
    own_netlist
);
page!(
    /// Golden waves in `cargo test`.
    regression_test
);
page!(
    /// Many geometries and forms of the hardware.
    sweep
);
page!(
    /// A network of integrators for curves that the catalogue has not: an Archimedean spiral, and the involute of a circle.
    spiral
);
