//! A sweep: a model, its geometries and its hardware choices, and the rows that they come to.

use std::collections::BTreeMap;
use std::ops::Range;

use rayon::prelude::*;
use serde_json::{Value as Json, json};
use stepwave_models::{Model, Options};
use stepwave_nc::{Curve, Description};

use super::columns::Layout;
use super::hardware_cache::{HardwareCache, PlannedHardware};
use super::space::{Space, SweepPart};
use super::table::{Column, Row};
use super::{StudyError, Variants};
use crate::testbench::Measured;

/// Most runs of a sweep, all parts together.
pub const MOST_RUNS: u64 = 1 << 32;
/// Fewer geometries of one hardware than these are not worth the building of lanes.
const FEW: usize = 16;

/// Runs to be done.
pub struct Sweep {
    model: &'static Model,
    space: Space,
    variants: Variants,
    part: SweepPart,
    layout: Layout,
    machines: HardwareCache,
    /// Geometries of all parts.
    all: u64,
    limit: u64,
}

/// One run, before it is done.
struct Task {
    geometry: usize,
    variant: usize,
    machine: Result<std::sync::Arc<PlannedHardware>, String>,
}

impl Sweep {
    /// Of this part of all geometries; each run ends after `limit` clocks, at most 2^31 - 1.
    ///
    /// # Errors
    /// There are no geometries or too many, or the model does not take an option.
    pub fn new(
        model: &'static Model,
        space: Space,
        variants: Variants,
        part: SweepPart,
        limit: u64,
    ) -> Result<Sweep, StudyError> {
        for dimension in &variants.0 {
            model.require(dimension.option)?;
        }
        let (geometries, count) = (space.count(), variants.count());
        let few = geometries.checked_mul(count).filter(|&runs| runs <= u128::from(MOST_RUNS));
        let all = few.and_then(|_| u64::try_from(geometries).ok());
        let Some(all) = all else {
            let variants = count.to_string();
            return Err(StudyError::TooMany { geometries: geometries.to_string(), variants, limit: MOST_RUNS });
        };
        let layout = Layout::new(model, &space, &variants)?;
        let machines = HardwareCache::new(model);
        Ok(Sweep { model, space, variants, part, layout, machines, all, limit })
    }

    /// The same with the least and the greatest speed over v_max and the ripple of each run. Runs are then done alone, not in
    /// lanes, which keep no windows of steps.
    #[must_use]
    pub fn with_ripple(self) -> Sweep {
        Sweep { layout: self.layout.with_ripple(), ..self }
    }

    /// The model.
    #[must_use]
    pub fn model(&self) -> &'static Model {
        self.model
    }

    /// Geometries of this part, with or without a curve.
    #[must_use]
    pub fn geometries(&self) -> u64 {
        self.part.count(self.all)
    }

    /// Runs of a geometry.
    #[must_use]
    pub fn variants(&self) -> u64 {
        // No more than `MOST_RUNS`, unless there is no geometry.
        u64::try_from(self.variants.count()).unwrap_or(u64::MAX)
    }

    /// The part.
    #[must_use]
    pub fn part(&self) -> SweepPart {
        self.part
    }

    /// The points that a map of this sweep shows, `from`, `to`, or `p1` of a free curve, and their ranges in x and y; none
    /// without a grid.
    #[must_use]
    pub fn map(&self) -> Option<(String, [super::Range; 2])> {
        self.space.map()
    }

    /// The columns of a row.
    #[must_use]
    pub fn columns(&self) -> &[Column] {
        &self.layout.columns
    }

    /// Place of a column.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<usize> {
        self.columns().iter().position(|column| column.name == name)
    }

    /// All that the rows follow from, for every part.
    #[must_use]
    pub fn identity(&self) -> Json {
        let ranges = |ranges: &[super::Range]| ranges.iter().map(super::Range::to_string).collect::<Vec<_>>();
        let cells = |cells: &super::Cells| {
            json!({
                "curve": format!("{:?}", cells.drawn),
                "sizes": ranges(&cells.sizes),
                "from": cells.from.as_deref().map(ranges),
                "to": cells.to.as_deref().map(ranges),
                "center": cells.center,
                "directions": cells.directions.iter().map(ToString::to_string).collect::<Vec<_>>(),
                "radii": cells.radii.to_string(),
            })
        };
        let space = match &self.space {
            Space::Cells(grid) => json!({ "grid": cells(grid) }),
            Space::Samples { cells: grid, count, seed } => {
                json!({ "grid": cells(grid), "samples": count, "seed": seed })
            }
            Space::Points { points, content } => {
                let radii = points.first().map(|site| site.radii.to_string());
                json!({ "points": points.len(), "content": content, "radii": radii })
            }
        };
        let words = self.variants.words().map(|(option, words)| (format!("--{}", option.name()), words));
        let choices: BTreeMap<String, Vec<&str>> = words.collect();
        json!({
            "stepwave": env!("CARGO_PKG_VERSION"),
            "model": self.model.name,
            "geometries": space,
            "choices": choices,
            "max_clocks": self.limit,
            "columns": self.columns(),
        })
    }

    /// The rows of some geometries of this part, by their place in it, in order. Done on all threads.
    ///
    /// # Errors
    /// A run fails by itself, which none should.
    pub fn rows(&self, places: Range<u64>) -> Result<Vec<Row>, StudyError> {
        let variants = usize::try_from(self.variants()).unwrap_or(usize::MAX);
        let numbers: Vec<u64> = places.map(|place| self.part.geometry(place)).collect();
        let geometries: Vec<(u64, Description, Result<Curve, String>)> = numbers
            .into_par_iter()
            .filter_map(|number| {
                let (site, geometry) = self.space.site(number)?;
                Some((number, site, geometry.map_err(|error| error.to_string())))
            })
            .collect();
        let options: Vec<(Options, Vec<&str>)> = if geometries.is_empty() {
            Vec::new()
        } else {
            (0..variants).map(|index| self.variants.at(index)).collect()
        };
        let tasks: Vec<Task> = (0..geometries.len() * variants)
            .into_par_iter()
            .map(|index| {
                let (geometry, variant) = (index / variants, index % variants);
                let machine = match &geometries[geometry].2 {
                    Ok(curve) => self.machines.plan(curve, &options[variant].0).map_err(|e| e.to_string()),
                    Err(reason) => Err(reason.clone()),
                };
                Task { geometry, variant, machine }
            })
            .collect();
        let curve = |task: &Task| geometries[task.geometry].2.as_ref().ok();
        let mut measured: Vec<Option<Result<Measured, String>>> =
            tasks.iter().map(|task| task.machine.as_ref().err().map(|reason| Err(reason.clone()))).collect();
        if !self.layout.ripple {
            self.in_lanes(&tasks, &curve, &mut measured);
        }
        let alone: Vec<(usize, Result<Measured, String>)> = (0..tasks.len())
            .into_par_iter()
            .filter(|&index| measured[index].is_none())
            .map(|index| {
                let (task, limit) = (&tasks[index], self.limit);
                let run = match (&task.machine, curve(task)) {
                    (Ok(machine), Some(curve)) => machine.alone(self.model, curve, limit, self.layout.ripple)?,
                    _ => Err(String::new()),
                };
                Ok((index, run))
            })
            .collect::<Result<_, StudyError>>()?;
        for (index, run) in alone {
            measured[index] = Some(run);
        }
        let row = |(task, run): (&Task, Option<Result<Measured, String>>)| {
            let (number, site, _) = &geometries[task.geometry];
            let index = number * self.variants() + task.variant as u64;
            self.layout.row(index, site, &options[task.variant].1, run.unwrap_or_else(|| Err(String::new())))
        };
        Ok(tasks.par_iter().zip(measured).map(row).collect())
    }

    /// Runs what can be run in lanes, one hardware after another.
    fn in_lanes<'t>(
        &self,
        tasks: &'t [Task],
        curve: &(impl Fn(&'t Task) -> Option<&'t Curve> + Sync),
        measured: &mut [Option<Result<Measured, String>>],
    ) {
        let mut groups: BTreeMap<usize, (&PlannedHardware, Vec<usize>)> = BTreeMap::new();
        for (index, task) in tasks.iter().enumerate() {
            if let Ok(machine) = &task.machine {
                groups.entry(machine.number).or_insert((machine, Vec::new())).1.push(index);
            }
        }
        for (machine, indexes) in groups.into_values() {
            if indexes.len() < FEW && !machine.is_built() {
                continue;
            }
            let Some(lanes) = machine.lanes(self.model, self.limit) else { continue };
            let curves: Vec<&Curve> = indexes.iter().filter_map(|&index| curve(&tasks[index])).collect();
            let mut places = indexes.into_iter();
            lanes.measure(curves.iter().copied(), |run| {
                if let Some(place) = places.next() {
                    measured[place] = match run {
                        Ok(run) => run.map(Ok),
                        Err(error) => Some(Err(error.to_string())),
                    };
                }
            });
        }
    }
}
