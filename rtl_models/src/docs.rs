//! Sentences of the documentation that several models share.

use crate::choices::Choice;
use crate::model::{ChoiceDoc, RegisterDoc};

impl RegisterDoc {
    pub(crate) const XI_YI: RegisterDoc =
        RegisterDoc { name: "xi, yi", width: "n", about: "|x|, |y| relative to the centre" };
    pub(crate) const QUAD: RegisterDoc =
        RegisterDoc { name: "quad", width: "2", about: "quadrant of the step, Q1 = 0 … Q4 = 3" };
    pub(crate) const EX_EY: RegisterDoc =
        RegisterDoc { name: "ex, ey", width: "n", about: "end-point down-counter of each axis (per-axis)" };
    pub(crate) const EX_EY_NEEDED: RegisterDoc =
        RegisterDoc { name: "ex, ey", width: "as they need", about: "end-point down-counter of each axis" };
    pub(crate) const BASE: RegisterDoc = RegisterDoc { name: "base", width: "1", about: "base axis, X = 0, Y = 1" };
    pub(crate) const SAMPLED_POINT: RegisterDoc =
        RegisterDoc { name: "cx, cy", width: "n+2+q", about: "coarse point of the period, in 2^-q BLU, signed" };
    pub(crate) const SAMPLED_JV: RegisterDoc =
        RegisterDoc { name: "jvx, jvy", width: "as f needs", about: "whole pulses of the period, double buffered" };
    pub(crate) const SAMPLED_JR: RegisterDoc =
        RegisterDoc { name: "jrx, jry", width: "as jv", about: "remainder of the fine stage, from the preset" };
    pub(crate) const POSITIONS: RegisterDoc =
        RegisterDoc { name: "x, y", width: "as the path needs, + 1", about: "machine position, signed" };
    pub(crate) const AXIS_POSITIONS: RegisterDoc =
        RegisterDoc { name: "x, y, …", width: "as the path needs, + 1", about: "machine position, signed" };
}

impl ChoiceDoc {
    pub(crate) const WIDTH: ChoiceDoc =
        ChoiceDoc { choice: Choice::Width, values: "N or REGISTER=N,… (default: the least that holds the geometry)" };
    pub(crate) const PRESET: ChoiceDoc =
        ChoiceDoc { choice: Choice::Preset, values: "zero (default) | half | full | N, or jrx=N,jry=N" };
    pub(crate) const NORMALIZE: ChoiceDoc =
        ChoiceDoc { choice: Choice::Normalize, values: "left-shift normalisation (default: none)" };
    pub(crate) const ARC_END_POINT: ChoiceDoc = ChoiceDoc {
        choice: Choice::EndPoint,
        values: "total (default where the end point is on the curve) | per-axis (default elsewhere)",
    };
    pub(crate) const WEIGHTS: ChoiceDoc = ChoiceDoc { choice: Choice::Weights, values: "mid (default) | pre | post" };
    pub(crate) const BEATS: ChoiceDoc = ChoiceDoc { choice: Choice::Beats, values: "4 (default) | 1" };
    pub(crate) const SAMPLED_WIDTH: ChoiceDoc = ChoiceDoc {
        choice: Choice::Width,
        values: "N of jv and jr, or REGISTER=N,… (default: the least for a period)",
    };
    pub(crate) const SYSTEM: ChoiceDoc = ChoiceDoc {
        choice: Choice::System,
        values: "7m (default), by the direction, T = 8 ms | 7360, by the step factor, T = 10.24 ms",
    };
    pub(crate) const FRACTION: ChoiceDoc = ChoiceDoc {
        choice: Choice::Fraction,
        values: "bits of the fraction of coarse points, 8 or more (default: 10)",
    };
    pub(crate) const ON_OVERFLOW: ChoiceDoc =
        ChoiceDoc { choice: Choice::OnOverflow, values: "trap (default) | saturate | wrap" };
}
