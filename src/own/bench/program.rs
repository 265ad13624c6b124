//! A netlist with a bench file runs whole programs: it is loaded with the geometry of each block, from where the machine is.

use super::geometry::Piece;
use super::{Bench, Pulses};
use crate::models::program::{HardwareBlock, Moves, Pacing, Size};
use crate::models::{AXES, CurveKind, Hardware, ModelError, Plan, Promise};
use crate::nc::{AXES_MAX, Crossing, Curve, Line, PulseBlock};

impl Bench {
    /// A block that it does not run: what is wrong, and the remedy.
    fn refused<T>(&self, what: &str) -> Result<T, ModelError> {
        Err(ModelError::Widths(format!("{}: {what}", self.file.display())))
    }
}

impl Moves for Bench {
    fn arcs(&self) -> bool {
        !matches!(self.curve, CurveKind::Line { .. })
    }

    /// Arcs are in the plane of x and y: others, and helices, become chords.
    fn takes(&self, block: &PulseBlock) -> bool {
        match &block.curve {
            Curve::Line(_) => true,
            Curve::Arc(_) => self.arcs() && block.axes == [0, 1] && !block.moves_others(),
            _ => false,
        }
    }

    fn check(&self, block: &PulseBlock) -> Result<(), ModelError> {
        if self.curve == CurveKind::Arc && !matches!(block.curve, Curve::Arc(_)) {
            return self.refused(
                "it says that the hardware takes arcs alone, and this move needs lines, as all do but arcs in the plane of x \
                 and y: give curves = \"both\", with an expression that reads `arc`, if the hardware takes lines",
            );
        }
        let pulses = |axis: usize| self.axes.get(axis).is_some_and(|pulses| !matches!(pulses, Pulses::Still));
        let missing = (0..AXES_MAX).find(|&axis| !pulses(axis) && block.travel(axis) != 0);
        missing.map_or(Ok(()), |axis| {
            let known: Vec<&str> = (0..AXES_MAX).filter(|&axis| pulses(axis)).map(|axis| AXES[axis]).collect();
            let (letter, known) = (AXES[axis], known.join(" and "));
            self.refused(&format!(
                "it says how {known} pulse, and this move goes along {letter}: add [axis.{letter}] if the hardware has one, or \
                 leave {letter} out of the program"
            ))
        })
    }

    fn crossing(&self) -> Crossing {
        Crossing::RoundedRadius
    }

    fn axes(&self, _: &Size) -> usize {
        self.axes.len()
    }

    fn pacing(&self) -> Pacing {
        Pacing::Hardware { reads_speed: self.reads_speed }
    }

    fn plan(&self, size: &Size, plan: &mut Plan) -> Result<(), ModelError> {
        self.planned(plan, size.positions.into_iter().take(self.axes.len()).map(Vec::from))
    }

    fn words(&self, hardware: &Hardware, block: &PulseBlock, speed: u64) -> Result<Vec<HardwareBlock>, ModelError> {
        let [from, to] = [block.from, block.to].map(|place| place[..self.axes.len()].to_vec());
        let line;
        let curve = match &block.curve {
            Curve::Line(_) => {
                // In the order of the axes, and not of a plane.
                let own = Line::new(from.clone(), to.clone());
                line = Curve::Line(own.or_else(|error| self.refused(&error.to_string()))?);
                &line
            }
            other => other,
        };
        let remedy = "divide the move, choose a larger --blu, or give another expression";
        let all = self.loaded(hardware, Piece { from, to, ..Piece::whole(curve) }, speed, remedy)?;
        let length = block.length();
        Ok(all.into_iter().map(|words| HardwareBlock { words, steps: 0.0, length }).collect())
    }

    fn promise(&self, _: &Hardware, _: &PulseBlock) -> Option<Promise> {
        None
    }
}
