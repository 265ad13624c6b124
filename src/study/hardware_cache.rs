//! The machines of a sweep: geometries that plan the same hardware share one, and its lanes.

use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock, RwLock};

use stepwave_models::options::NORMALIZE;
use stepwave_models::{Hardware, Model, ModelError, Options};
use stepwave_nc::Curve;

use super::StudyError;
use crate::testbench::{Lanes, Measured, Testbench};

/// Machines kept; beyond them all are forgotten and built anew where they are needed.
const KEPT: usize = 512;

/// One hardware, built when it is needed.
pub(super) struct PlannedHardware {
    /// Unlike that of any other.
    pub(super) number: usize,
    hardware: Hardware,
    bench: OnceLock<Result<Testbench, ModelError>>,
    lanes: OnceLock<Option<Lanes>>,
}

impl PlannedHardware {
    fn bench(&self, model: &Model) -> Result<&Testbench, &ModelError> {
        self.bench
            .get_or_init(|| Ok(Testbench::of_hardware(model, self.hardware.clone())?.as_hardware_loads()))
            .as_ref()
    }

    /// The lanes are there already.
    pub(super) fn is_built(&self) -> bool {
        self.lanes.get().is_some()
    }

    /// The lanes, if its path can be measured in lanes.
    pub(super) fn lanes(&self, model: &Model, limit: u64) -> Option<&Lanes> {
        let build = || self.bench(model).ok()?.measuring_lanes(limit).ok().flatten();
        self.lanes.get_or_init(build).as_ref()
    }

    /// Runs one geometry alone, with the `ripple` of its speed if that is wanted; inside, why the hardware refuses it.
    ///
    /// # Errors
    /// The run fails by itself.
    pub(super) fn alone(
        &self,
        model: &Model,
        curve: &Curve,
        limit: u64,
        ripple: bool,
    ) -> Result<Result<Measured, String>, StudyError> {
        let bench = match self.bench(model) {
            Ok(bench) => bench.of(model, curve),
            Err(error) => return Ok(Err(error.to_string())),
        };
        let run = match bench {
            Ok(bench) if ripple => bench.measure_ripple(curve, limit),
            Ok(bench) => bench.measure(curve, limit),
            Err(error) => return Ok(Err(error.to_string())),
        };
        run.map(Ok).map_err(|error| StudyError::Run(error.to_string()))
    }
}

/// All machines that are known.
pub(super) struct HardwareCache {
    model: &'static Model,

    known: RwLock<HashMap<u64, Vec<Arc<PlannedHardware>>>>,
    made: AtomicUsize,
}

/// What distinguishes most hardware.
fn digest(hardware: &Hardware) -> u64 {
    let mut hasher = DefaultHasher::new();
    hardware.widths.values().for_each(|width| width.get().hash(&mut hasher));
    (hardware.axes, hardware.get(&NORMALIZE), hardware.stall_clocks).hash(&mut hasher);
    hasher.finish()
}

impl HardwareCache {
    pub(super) fn new(model: &'static Model) -> HardwareCache {
        HardwareCache { model, known: RwLock::default(), made: AtomicUsize::new(0) }
    }

    /// The machine that a geometry plans with these choices.
    ///
    /// # Errors
    /// The model refuses the geometry or a choice.
    pub(super) fn plan(&self, curve: &Curve, choices: &Options) -> Result<Arc<PlannedHardware>, ModelError> {
        let hardware = self.model.plan(curve, choices)?;
        let digest = digest(&hardware);
        let alike = |machines: &Vec<Arc<PlannedHardware>>| {
            machines.iter().find(|machine| machine.hardware == hardware).cloned()
        };
        // A lock is poisoned only by a panic, which ends the sweep.
        if let Some(machine) = self.known.read().ok().and_then(|known| known.get(&digest).and_then(alike)) {
            return Ok(machine);
        }
        let number = || self.made.fetch_add(1, Ordering::Relaxed);
        let machine = |hardware| {
            Arc::new(PlannedHardware { number: number(), hardware, bench: OnceLock::new(), lanes: OnceLock::new() })
        };
        let Ok(mut known) = self.known.write() else { return Ok(machine(hardware)) };
        if let Some(machine) = known.get(&digest).and_then(alike) {
            return Ok(machine);
        }
        if known.values().map(Vec::len).sum::<usize>() >= KEPT {
            known.clear();
        }
        let machine = machine(hardware);
        known.entry(digest).or_default().push(Arc::clone(&machine));
        Ok(machine)
    }
}
