//! What can be wrong with an NC program.

use std::io;

use super::words::{DIGITS_LIMIT, LINE_LIMIT};
use super::{CENTER_TOLERANCE, PROGRAM_LIMIT, TURNS_LIMIT};
use crate::{NURBS_MOST, NURBS_POINTS};

/// Why a program cannot be read, and where.
#[derive(Debug, thiserror::Error)]
#[error("line {line}, column {column}: {kind}")]
pub struct ProgramError {
    /// The line, from 1.
    pub line: u64,
    /// The column, from 1, in characters.
    pub column: u64,
    /// What is wrong.
    #[source]
    pub kind: ProgramErrorKind,
}

/// What is wrong with a program; every message names the word, the limit and the remedy.
///
/// `word` is always as it was written, without blanks.
#[derive(Debug, thiserror::Error)]
pub enum ProgramErrorKind {
    /// The program cannot be read from where it is kept.
    #[error("the program cannot be read any further: {0}")]
    Read(#[source] io::Error),
    /// A line is too long.
    #[error("the line is longer than {LINE_LIMIT} bytes: break it into blocks, or check that this is an NC program")]
    Overlong,
    /// A byte is not part of UTF-8.
    #[error("the byte \\x{byte:02x} is not UTF-8 text: save the program as UTF-8 or ASCII")]
    InvalidUtf8 {
        /// The byte.
        byte: u8,
    },
    /// A character has no meaning in its place.
    #[error("'{}' does not belong here, only words such as X12.5 and comments do: remove it", .character.escape_debug())]
    UnexpectedCharacter {
        /// The character.
        character: char,
    },
    /// A comment has no end.
    #[error("the comment that begins here is not closed in its line: put a ) after it")]
    OpenComment,
    /// A comment begins in a comment.
    #[error("a ( inside a comment would begin a second one, which RS-274 does not allow: remove it")]
    NestedComment,
    /// A per cent sign is not alone.
    #[error("% marks the beginning and the end of a program and is alone in its line: break the line there")]
    PercentInBlock,
    /// A letter has no number.
    #[error("{letter} has no number: write one after it, such as {letter}1")]
    NumberExpected {
        /// The letter.
        letter: char,
    },
    /// A number has an exponent.
    #[error("exponents are not part of RS-274: write {plain}")]
    Exponent {
        /// The word.
        word: String,
        /// The word without exponent.
        plain: String,
    },
    /// A number has too many digits.
    #[error("the number of {letter} has more than {DIGITS_LIMIT} digits: round it")]
    TooManyDigits {
        /// The letter.
        letter: char,
    },
    /// A parameter is used.
    #[error("parameters (#) are not supported: write the number itself")]
    Parameter,
    /// An expression is used.
    #[error("expressions ([ ]) are not supported: write the number itself")]
    Expression,
    /// An O word is more than the number of the program.
    #[error(
        "{word} is not the number of the program, alone in front of its first block, and O words of flow control are \
         not supported: write the blocks out in the order in which they run"
    )]
    FlowControl {
        /// The word, or the letter where no number follows.
        word: String,
    },
    /// A word is not among the supported ones.
    #[error(
        "{word} is not supported: rewrite the block with G00 to G03 along X, Y, Z, A, B, C, U, V or W, or remove the word if it does not matter here"
    )]
    Unsupported {
        /// The word.
        word: String,
    },
    /// A number has a fraction.
    #[error("{word} is not a whole number: the number of {} counts, give it without a fraction", letter(.word))]
    NotInteger {
        /// The word.
        word: String,
    },
    /// A number is negative.
    #[error("{word} is negative and must be at least 0: remove the sign")]
    Negative {
        /// The word.
        word: String,
    },
    /// An N word is not the first word.
    #[error("{word} must be the first word of its block: move it to the front")]
    NumberNotFirst {
        /// The word.
        word: String,
    },
    /// A letter is used twice.
    #[error(
        "{word} repeats the letter of {first}, and one block takes it once: keep one of them, or break the block in two"
    )]
    Repeated {
        /// The word.
        word: String,
        /// The word in front of it.
        first: String,
    },
    /// Two G or M words of one modal group are in one block.
    #[error("{word} is of the same modal group as {first}, and one block takes one of them: break the block in two")]
    SameGroup {
        /// The word.
        word: String,
        /// The word in front of it.
        first: String,
    },
    /// A word belongs to G05 and to G04 or G64.
    #[error("{word} would belong to G05 and to G04 or G64 as well: break the block in two")]
    TwoOwners {
        /// The word.
        word: String,
    },
    /// Nothing in the block uses a word.
    #[error("{word} has nothing that uses it in this block: it belongs to {owner}, give that too or remove the word")]
    Unused {
        /// The word.
        word: String,
        /// The words that it may belong to.
        owner: &'static str,
    },
    /// The number of turns of an arc is not one.
    #[error(
        "{word} is the number of turns of the arc, of which the last may be a part: give a whole number from 1 to {TURNS_LIMIT}"
    )]
    Turns {
        /// The word.
        word: String,
    },
    /// A move to the machine's home under compensation.
    #[error(
        "{word} moves by the machine's zero while tool radius compensation is on: write G40 into a block in front of it"
    )]
    HomeUnderCompensation {
        /// The word.
        word: String,
    },
    /// G53 without a straight motion.
    #[error(
        "{word} moves in a straight line, and no G00 or G01 is in force: write the one that is meant into the block"
    )]
    MachineMove {
        /// The word.
        word: String,
    },
    /// A coordinate is given and no motion is in force.
    #[error("{word} is given, but no G00, G01, G02 or G03 is in force: write the one that is meant into the block")]
    NoMotion {
        /// The word.
        word: String,
    },
    /// A feed move has no feed.
    #[error("the block moves at a feed, but no F word has been given: write one into this block or one in front of it")]
    NoFeed,
    /// A feed move has no F word under G93.
    #[error(
        "under G93 every block with G01, G02, G03, G05 or G05.1 needs its own F word: write one, or go back to G94"
    )]
    NoInverseTime,
    /// A feed is 0 or negative.
    #[error("invalid feed {word}, which must be more than 0: correct the F word")]
    FeedNotPositive {
        /// The word.
        word: String,
    },
    /// A length is too large.
    #[error(
        "{name} = {value} BLU is beyond the limit of ±{PROGRAM_LIMIT} BLU: correct the word or choose a larger BLU"
    )]
    BeyondLimit {
        /// What it is, such as X or the centre in Z.
        name: String,
        /// The length, in BLU.
        value: f64,
    },
    /// A feed, a time or a speed is too large.
    #[error("{word} is beyond the limit of {PROGRAM_LIMIT}: correct the word")]
    NumberBeyondLimit {
        /// The word.
        word: String,
    },
    /// A dwell has no time.
    #[error("{word} needs the time in seconds as a P word of at least 0, such as P0.5: write one")]
    NoDwellTime {
        /// The word.
        word: String,
    },
    /// Compensation is switched on without a tool.
    #[error(
        "{word} needs a D word that names the tool, such as {word} D1: write one, and give its radius with `--tool D=RADIUS`"
    )]
    NoTool {
        /// The word.
        word: String,
    },
    /// A tool is not in the table.
    #[error(
        "no radius is known for the tool of D{number}: give it with `--tool D=RADIUS`, such as `--tool {number}=4mm`"
    )]
    UnknownTool {
        /// The D number.
        number: u64,
    },
    /// The plane is changed under compensation.
    #[error("{word} changes the plane while tool radius compensation is on: write G40 into a block in front of it")]
    PlaneUnderCompensation {
        /// The word.
        word: String,
    },
    /// An arc has no centre.
    #[error("the arc has no centre: give {} or a radius R", .words)]
    NoCenter {
        /// The two words of the plane.
        words: &'static str,
    },
    /// An arc under G90.1 has one coordinate of its centre.
    #[error("under G90.1 the centre needs both {words}: give the one that is missing, or go back to G91.1")]
    HalfCenter {
        /// The two words of the plane.
        words: &'static str,
    },
    /// A centre word is not of the plane.
    #[error(
        "{word} is no centre word of the plane {plane}, which has {words}: choose the plane of the arc or correct the word"
    )]
    CenterOffPlane {
        /// The word.
        word: String,
        /// The G word of the plane.
        plane: &'static str,
        /// The two words of the plane.
        words: &'static str,
    },
    /// An arc has both a radius and a centre.
    #[error("the arc has both {word} and a centre by I, J or K: keep one of them")]
    RadiusAndCenter {
        /// The R word.
        word: String,
    },
    /// The radius of an arc is 0.
    #[error("the arc has radius 0 and must have more: correct the centre or the R word")]
    ZeroRadius,
    /// An arc by its radius ends where it starts.
    #[error(
        "the arc ends where it starts, and {word} does not say where its centre is: give a full circle by I, J or K"
    )]
    CircleByRadius {
        /// The R word.
        word: String,
    },
    /// The radius of an arc does not reach from its start to its end.
    #[error(
        "the radius {radius:.3} BLU is less than half of the chord, {half:.3} BLU, by more than {tolerance:.3} BLU: \
         give a larger R or a nearer end point{}", accepted(.half - .radius - .tolerance, *.more)
    )]
    RadiusTooSmall {
        /// The radius given, in BLU.
        radius: f64,
        /// Half of the distance from start to end, in BLU.
        half: f64,
        /// The difference allowed, in BLU.
        tolerance: f64,
        /// What `--tolerance` is, and may be at most, in BLU.
        more: [f64; 2],
    },
    /// The end of an arc is not on its circle.
    #[error(
        "the radius is {start:.3} BLU at the start point but {end:.3} BLU at the end point, and they may differ by at \
         most {tolerance:.3} BLU ({CENTER_TOLERANCE}): correct the centre or the end point{}",
        accepted((.end - .start).abs() - .tolerance, *.more)
    )]
    EndOffCircle {
        /// Distance of the start point from the centre, in BLU.
        start: f64,
        /// Distance of the end point from the centre, in BLU.
        end: f64,
        /// The difference allowed, in BLU.
        tolerance: f64,
        /// What `--tolerance` is, and may be at most, in BLU.
        more: [f64; 2],
    },
    /// A free curve under compensation.
    #[error(
        "{word} is a free curve, and tool radius compensation is on: write G40, and the straight move that ends it, into blocks in front of it"
    )]
    SplineUnderCompensation {
        /// The word.
        word: String,
    },
    /// A G05 or G05.1 outside of the plane XY.
    #[error("{word} belongs to {name}, which is in the plane XY: write G17 into this block or one in front of it")]
    SplinePlane {
        /// The word.
        word: String,
        /// The G word of the curve.
        name: &'static str,
    },
    /// A G05 or G05.1 without an end.
    #[error("{word} belongs to {name}, which needs its end point: give X or Y, or both")]
    SplineEnd {
        /// The word.
        word: String,
        /// The G word of the curve.
        name: &'static str,
    },
    /// The first control point of a curve is missing.
    #[error(
        "{word}: {name} needs I and J from its start to its control point, G05 both, or neither where the block before is a \
         G05, and G05.1 one that is not 0"
    )]
    SplineHandle {
        /// The word.
        word: String,
        /// The G word of the curve.
        name: &'static str,
    },
    /// The second control point of a G05 is missing.
    #[error("{word}: a G05 needs both P and Q, from its end to its second control point: give both")]
    SplineEndHandle {
        /// The word.
        word: String,
    },
    /// A NURBS is not ended.
    #[error(
        "{word} begins a NURBS, and between it and G05.3 there are control points only: write G05.3 in front of other motions, \
         of another plane and of the end"
    )]
    NurbsOpen {
        /// The word that began it.
        word: String,
    },
    /// A G05.3 without G05.2.
    #[error("{word} ends a NURBS, but none was begun: begin one with G05.2")]
    NurbsNotOpen {
        /// The word.
        word: String,
    },
    /// A control point of a NURBS has one coordinate.
    #[error("{word} gives a control point of a NURBS, which needs both {} and {}: give both", .axes[0], .axes[1])]
    NurbsHalfPoint {
        /// The first word of the block.
        word: String,
        /// The two axes of the plane.
        axes: [char; 2],
    },
    /// A weight without a control point.
    #[error(
        "{word} gives a weight without {} and {}, which only the first block of a NURBS may, for the start point: give the \
         control point too", .axes[0], .axes[1]
    )]
    NurbsWeightAlone {
        /// The first word of the block.
        word: String,
        /// The two axes of the plane.
        axes: [char; 2],
    },
    /// A weight is not positive.
    #[error("{word} is the weight of a control point, which must be from 0.000001 to {NURBS_MOST}: correct it")]
    NurbsPointWeight {
        /// The word.
        word: String,
    },
    /// The order of a NURBS is out of range.
    #[error("{word} is the order of a NURBS, its degree and 1: give a whole number from {least} to {most}")]
    NurbsOrder {
        /// The word.
        word: String,
        /// The least order.
        least: usize,
        /// The greatest order.
        most: usize,
    },
    /// A NURBS has too few control points.
    #[error(
        "{word} ends a NURBS of {count} control points, its start among them, but of the order {order} it needs as many: \
         give more points, or a lower L"
    )]
    NurbsTooFew {
        /// The word.
        word: String,
        /// Control points given.
        count: usize,
        /// The order.
        order: usize,
    },
    /// A NURBS has too many control points.
    #[error("{word} gives a control point more than the {NURBS_POINTS} that a NURBS may have: break the curve in two")]
    NurbsTooMany {
        /// The first word of the block.
        word: String,
    },
    /// A curve needs too many chords.
    #[error("the curve needs {limit} chords or more: choose a larger BLU or a larger --chords")]
    TooManyChords {
        /// The greatest number.
        limit: usize,
    },
    /// No block of the program moves.
    #[error("the program ends and no block of it moved the tool: give it one with G00 to G03 and a coordinate")]
    Empty,
}

/// Why a program cannot be read with a [`Reading`](super::Reading).
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ReadingError {
    /// The BLU is not a length.
    #[error("invalid BLU of {blu} mm: give more than 0, such as 0.001")]
    Blu {
        /// The BLU given, in mm.
        blu: f64,
    },
    /// The BLU of rotary axes is not an angle.
    #[error("invalid BLU of {degrees} degrees: give more than 0, such as 0.001")]
    Degrees {
        /// The BLU given, in degrees.
        degrees: f64,
    },
    /// The tolerance of radii is not a length.
    #[error("a tolerance of {tolerance} BLU is invalid: give at least 0")]
    Tolerance {
        /// The tolerance given, in BLU.
        tolerance: f64,
    },
    /// The distance of chords from their curve is not a length.
    #[error("chords {chords} BLU off their curve are invalid: give more than 0")]
    Chords {
        /// The distance given, in BLU.
        chords: f64,
    },
    /// A coordinate of the home is not a place.
    #[error("the home {home:?} mm is invalid: give three coordinates that a program may have")]
    Home {
        /// The home given, in mm.
        home: [f64; 3],
    },
    /// A tool radius is not a length.
    #[error("tool {number} has a radius of {radius} mm, but at least 0 is needed: give the other side by G41 or G42")]
    ToolRadius {
        /// The D number.
        number: u64,
        /// The radius given, in mm.
        radius: f64,
    },
}

/// What is wrong in a line, before the line is known.
#[derive(Debug)]
pub(super) struct Fault {
    pub(super) column: u64,
    pub(super) kind: ProgramErrorKind,
}

/// The tolerance that would accept an arc whose radii differ by this much too much, where one may.
fn accepted(excess: f64, [given, most]: [f64; 2]) -> String {
    let wanted = ((given + excess) * 1000.0).ceil() / 1000.0;
    if wanted > most { String::new() } else { format!(", or accept it with --tolerance {wanted}") }
}

fn letter(word: &str) -> &str {
    word.get(..1).unwrap_or(word)
}
