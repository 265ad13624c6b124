//! What models interpolate: the kinds of curves, and how a model plans its hardware for a curve and loads it.

use stepwave_nc::{
    Arc, Conic, Curve, CurveType, Direction, Drawn, GeometryError, Helix, Line, Nurbs, Spline, SplineForm,
};

use crate::described::Described;
use crate::error::ModelError;
use crate::hardware::Hardware;
use crate::machine::Words;
use crate::plan::Plan;
use crate::program::Paced;
use crate::registers::AXES;

/// What a model interpolates.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum CurveKind {
    /// Displacements of one axis.
    Axis,
    /// Lines of 2 up to this many axes.
    Line {
        /// Most axes.
        max_axes: usize,
    },
    /// Circular arcs in the plane.
    Arc,
    /// Arcs of ellipses, parabolas and hyperbolas in the plane.
    Conic,
    /// Circular arcs in the plane with a displacement in z.
    Helix,
    /// Free curves in the plane.
    Spline,
    /// Rational B-splines in the plane.
    Nurbs,
    /// What a program is made of: lines of 2 to 9 axes, circular arcs in the plane, and helices.
    Move,
}

static SPLINES: [Drawn; 4] = {
    let [bezier, hermite, through, along] = SplineForm::ALL;
    [Drawn::Spline(bezier), Drawn::Spline(hermite), Drawn::Spline(through), Drawn::Spline(along)]
};

/// What is said of one kind.
struct Traits {
    name: &'static str,
    takes: &'static str,
    in_box: &'static str,
    axes: [usize; 2],
    drawn: &'static [Drawn],
}

impl CurveKind {
    /// All kinds, of lines those of most axes.
    pub const ALL: [CurveKind; 8] = [
        CurveKind::Axis,
        CurveKind::Line { max_axes: 6 },
        CurveKind::Arc,
        CurveKind::Conic,
        CurveKind::Helix,
        CurveKind::Spline,
        CurveKind::Nurbs,
        CurveKind::Move,
    ];

    fn traits(self) -> Traits {
        match self {
            CurveKind::Axis => Traits {
                name: "axis",
                takes: "displacements of one axis (--from X --to X)",
                in_box: "displacements of one axis",
                axes: [1, 1],
                drawn: &[Drawn::Line],
            },
            CurveKind::Line { max_axes } => Traits {
                name: "line",
                takes: match max_axes {
                    2 => "lines of 2 axes (--from X,Y --to X,Y)",
                    3 => "lines of 2 or 3 axes (--from X,Y[,Z] --to X,Y[,Z])",
                    4 => "lines of 2 to 4 axes (--from X,Y,… --to X,Y,…)",
                    5 => "lines of 2 to 5 axes (--from X,Y,… --to X,Y,…)",
                    6 => "lines of 2 to 6 axes (--from X,Y,… --to X,Y,…)",
                    7 => "lines of 2 to 7 axes (--from X,Y,… --to X,Y,…)",
                    8 => "lines of 2 to 8 axes (--from X,Y,… --to X,Y,…)",
                    _ => "lines of 2 to 9 axes (--from X,Y,… --to X,Y,…)",
                },
                in_box: "lines from the origin",
                axes: [2, max_axes],
                drawn: &[Drawn::Line],
            },
            CurveKind::Arc => Traits {
                name: "arc",
                takes: "arcs (--from X,Y --to X,Y --center X,Y --cw|--ccw)",
                in_box: "arcs about the origin inside a quadrant, with both ends on the circle",
                axes: [2, 2],
                drawn: &[Drawn::Arc],
            },
            CurveKind::Conic => Traits {
                name: "conic",
                takes: "conics (--ellipse A,B --cw|--ccw, --parabola C or --hyperbola A,B; --from X,Y --to X,Y --center X,Y)",
                in_box: "conics about the origin",
                axes: [2, 2],
                drawn: &[Drawn::Ellipse, Drawn::Parabola(None), Drawn::Hyperbola(None)],
            },
            CurveKind::Helix => Traits {
                name: "helix",
                takes: "helices (--from X,Y,Z --to X,Y,Z --center X,Y --cw|--ccw)",
                in_box: "helices about the origin",
                axes: [2, 3],
                drawn: &[Drawn::Helix],
            },
            CurveKind::Spline => Traits {
                name: "spline",
                takes: "free curves (--bezier X,Y,…, --hermite X,Y,TX,TY,X,Y,TX,TY, or --points FILE [--b-spline])",
                in_box: "free curves",
                axes: [2, 2],
                drawn: &SPLINES,
            },
            CurveKind::Nurbs => Traits {
                name: "NURBS",
                takes: "NURBS (--nurbs X,Y,W,… or FILE [--degree P] [--knots U,…], or --bezier X,Y,…)",
                in_box: "free curves",
                axes: [2, 2],
                drawn: &[Drawn::Nurbs],
            },
            CurveKind::Move => Traits {
                name: "move",
                takes: "lines of 2 to 9 axes, arcs and helices (--from X,Y,… --to X,Y,…, of arcs --center X,Y --cw|--ccw)",
                in_box: "lines from the origin, and arcs about it inside a quadrant with both ends on the circle",
                axes: [2, AXES.len()],
                drawn: &[Drawn::Line, Drawn::Arc, Drawn::Helix],
            },
        }
    }

    /// The noun: `arc`.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.traits().name
    }

    /// In words, with the options that give it.
    #[must_use]
    pub fn describe(self) -> &'static str {
        self.traits().takes
    }

    /// Those that a box of coordinates is made of.
    #[must_use]
    pub fn in_box(self) -> &'static str {
        self.traits().in_box
    }

    /// Most axes of such a curve.
    #[must_use]
    pub fn max_axes(self) -> usize {
        self.traits().axes[1]
    }

    /// What may be drawn.
    #[must_use]
    pub fn drawn(self) -> &'static [Drawn] {
        self.traits().drawn
    }

    /// This may be drawn, wherever it opens to.
    #[must_use]
    pub fn has(self, drawn: Drawn) -> bool {
        self.drawn().contains(&drawn.opening(None))
    }

    /// The curve is of this kind.
    #[must_use]
    pub fn fits(self, curve: &Curve) -> bool {
        let Traits { axes: [least, most], .. } = self.traits();
        self.has(curve.description().drawn) && (least..=most).contains(&curve.axes())
    }

    /// Small curves of this kind: of lines also one in space, where the kind has any.
    ///
    /// # Errors
    /// None of these: they are curves.
    pub fn samples(self) -> Result<Vec<Curve>, GeometryError> {
        let turn = Direction::CounterClockwise;
        let one: Curve = match self {
            CurveKind::Axis => Line::new(vec![0], vec![8])?.into(),
            CurveKind::Line { max_axes: 2 } => Line::new(vec![0, 0], vec![8, 6])?.into(),
            CurveKind::Line { .. } => {
                let space = Line::new(vec![0; 3], vec![8, 6, 3])?.into();
                return Ok(vec![Line::new(vec![0, 0], vec![8, 6])?.into(), space]);
            }
            CurveKind::Arc => Arc::new([5, 0], [0, 5], [0, 0], turn)?.into(),
            CurveKind::Move => {
                let space = Line::new(vec![0; 5], vec![8, 6, 3, 1, 2])?.into();
                return Ok(vec![Arc::new([5, 0], [0, 5], [0, 0], turn)?.into(), space]);
            }
            CurveKind::Conic => Conic::ellipse([6, 4], [6, 0], [0, 4], [0, 0], turn)?.into(),
            CurveKind::Helix => Helix::new([5, 0, 0], [0, 5, 3], [0, 0], turn)?.into(),
            CurveKind::Spline => Spline::new(SplineForm::Bezier, &[[0, 0], [4, 0], [8, 4], [8, 8]])?.into(),
            CurveKind::Nurbs => Nurbs::bezier(&[[0, 0], [4, 0], [8, 4], [8, 8]])?.into(),
        };
        Ok(vec![one])
    }
}

/// How a model plans its hardware for a curve of type C, and loads one.
#[derive(Debug)]
pub struct Method<C: 'static> {
    /// Fixes registers, widths and promises for a curve; all that the hardware depends on comes from here.
    ///
    /// An error names a width or a value that cannot be.
    pub plan: fn(&C, &mut Plan) -> Result<(), ModelError>,
    /// The words of every block of a curve: one for a line, one for each sector of an arc where the loader has to reload
    /// the registers.
    pub load: fn(&C, &Hardware) -> Vec<Words>,
}

/// What a model interpolates, and how it plans and loads it.
#[derive(Debug)]
pub enum Interpolates {
    /// Displacements of one axis.
    Axis(Method<Line>),
    /// Lines of 2 up to this many axes.
    Lines(usize, Method<Line>),
    /// Circular arcs in the plane.
    Arcs(Method<Arc>),
    /// Arcs of ellipses, parabolas and hyperbolas in the plane.
    Conics(Method<Conic>),
    /// Circular arcs in the plane with a displacement in z.
    Helices(Method<Helix>),
    /// Free curves in the plane.
    Splines(Method<Spline>),
    /// Rational B-splines in the plane.
    Nurbs(Method<Nurbs>),
    /// The moves of a program, or one of them alone.
    Moves(Paced),
    /// What data describe, wiring included: [`Model::hardware`](crate::Model::hardware) is not called.
    Described(&'static dyn Described),
}

/// How a model plans its hardware for a curve, and loads one, whatever the type of its curves.
pub(crate) trait AnyMethod {
    /// Plans for a curve; `None` of another type.
    fn plan(&self, curve: &Curve, plan: &mut Plan) -> Option<Result<(), ModelError>>;
    /// The words of every block; none of a curve of another type.
    fn load(&self, curve: &Curve, hardware: &Hardware) -> Vec<Words>;
}

impl<C: CurveType> AnyMethod for Method<C> {
    fn plan(&self, curve: &Curve, plan: &mut Plan) -> Option<Result<(), ModelError>> {
        C::of(curve).map(|curve| (self.plan)(curve, plan))
    }

    fn load(&self, curve: &Curve, hardware: &Hardware) -> Vec<Words> {
        C::of(curve).map_or_else(Vec::new, |curve| (self.load)(curve, hardware))
    }
}

impl Interpolates {
    /// The curves, and the method for each of them if they are all of one type.
    pub(crate) fn of(&self) -> (CurveKind, Option<&dyn AnyMethod>) {
        match self {
            Interpolates::Axis(method) => (CurveKind::Axis, Some(method)),
            Interpolates::Lines(max_axes, method) => (CurveKind::Line { max_axes: *max_axes }, Some(method)),
            Interpolates::Arcs(method) => (CurveKind::Arc, Some(method)),
            Interpolates::Conics(method) => (CurveKind::Conic, Some(method)),
            Interpolates::Helices(method) => (CurveKind::Helix, Some(method)),
            Interpolates::Splines(method) => (CurveKind::Spline, Some(method)),
            Interpolates::Nurbs(method) => (CurveKind::Nurbs, Some(method)),
            Interpolates::Moves(moves) if moves.arcs.is_some() => (CurveKind::Move, None),
            Interpolates::Moves(_) => (CurveKind::Line { max_axes: AXES.len() }, None),
            Interpolates::Described(described) => (described.curve(), None),
        }
    }
}
