//! What a report is put together from.

use super::source::Source;
use crate::report::{Report, Subject};
use crate::testbench::{
    CoarseWatch, Observer, Outcome, OutputWatch, OverflowWatch, PathWatch, RangeWatch, SpacingWatch, SpeedWatch,
    Testbench,
};

/// What looks on for the report; the account of a program keeps itself.
pub(super) struct Watches<'a> {
    overflow: OverflowWatch,
    ranges: RangeWatch,
    curve: Option<OfCurve<'a>>,
    output: Option<OutputWatch>,
}

/// What looks on along a curve.
struct OfCurve<'a> {
    path: PathWatch<'a>,
    spacing: SpacingWatch,
    speed: SpeedWatch,
    coarse: Option<CoarseWatch<'a>>,
}

impl<'a> Watches<'a> {
    pub(super) fn new(bench: &Testbench, source: &'a Source) -> Watches<'a> {
        let curve = match source {
            Source::Curve(curve) => Some(OfCurve {
                path: PathWatch::new(bench, curve),
                spacing: SpacingWatch::new(bench, curve),
                speed: SpeedWatch::new(bench),
                coarse: CoarseWatch::new(bench, curve),
            }),
            Source::Program(_) => None,
        };
        let output = OutputWatch::of(bench);
        Watches { overflow: OverflowWatch::new(bench), ranges: RangeWatch::new(bench), curve, output }
    }

    pub(super) fn observers<'o>(&'o mut self, subject: &'o mut Subject) -> Vec<&'o mut dyn Observer> {
        let mut all: Vec<&mut dyn Observer> = vec![&mut self.overflow, &mut self.ranges];
        all.extend(self.output.as_mut().map(|output| output as &mut dyn Observer));
        if let Some(OfCurve { path, spacing, speed, coarse }) = &mut self.curve {
            all.extend([path as &mut dyn Observer, spacing, speed]);
            all.extend(coarse.as_mut().map(|coarse| coarse as &mut dyn Observer));
        }
        if let Subject::Program(of) = subject {
            all.push(&mut of.totals);
        }
        all
    }

    /// Fills the results in.
    pub(super) fn finish(self, report: &mut Report, outcome: Outcome) {
        report.outcome = outcome;
        report.sent = self.output.map(OutputWatch::finish);
        report.ranges = self.ranges.finish();
        report.overflows = self.overflow.events();
        report.overflow_count = self.overflow.count;
        report.tallies = self.overflow.tallies();
        if let (Some(OfCurve { path, spacing, speed, coarse }), Subject::Curve(of)) = (self.curve, &mut report.subject)
        {
            of.worst = path.worst;
            of.trains = spacing.finish();
            of.speed = speed.finish();
            of.coarse = coarse.and_then(|coarse| coarse.worst);
        }
    }
}
