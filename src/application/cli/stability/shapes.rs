//! The shapes of modes, for ParaView.

use crate::analysis::stability::{Shape, shapes};
use crate::analysis::{JobError, Structures};
use crate::cli::error::CliError;
use crate::cli::foreground;
use crate::cli::output::log;
use crate::exit;
use crate::inspect::write_mode;
use crate::publish::{Folder, value};
use crate::report::{ShownModes, assignment};
use crate::solver::Model;
use crate::study::Job;
use crate::sweep::{Plan, parameters_of};
use crate::worker::Interrupt;
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use std::path::Path;

/// The largest number of points whose shapes are written. A mode of a fine mesh takes some 100 MB.
const MAX_POINTS: usize = 50;

/// The largest amplitude of a shape, as a share of the pin's shortest edge.
const AMPLITUDE: f64 = 0.05;

/// The points of the grid, whose shapes are to be written.
pub(super) fn points(plan: &Plan) -> Result<Vec<Job>, CliError> {
    let count = plan.jobs().len();
    if count > MAX_POINTS {
        return Err(CliError::Usage(format!(
            "--shapes writes the shapes of at most {MAX_POINTS} points, and the grid has {count}\n  help: take a part of \
             the grid, for example with --set mu=0.4, or leave --shapes out"
        )));
    }
    Ok(plan.jobs().to_vec())
}

/// Computes the points again, because shapes are not stored, and writes the modes of each that are shown into a folder.
/// Returns the exit code.
pub(super) fn write(
    points: &[Job],
    modes: ShownModes,
    threads: usize,
    folder: &Path,
) -> Result<u8, CliError> {
    let interrupt = foreground::interrupt();
    let stop = interrupt.clone();
    let structures = Structures::stopped_when(move || stop.is_raised());
    let mut files = Folder::create(folder, "modes")?;
    let (mut code, mut written) = (exit::SUCCESS, 0);
    // All shapes of a large study at once would need too much memory.
    for part in points.chunks(threads) {
        if interrupt.is_raised() {
            return foreground::exit_code(JobError::Interrupted);
        }
        let found: Vec<_> = part.par_iter().map(|job| of_point(job, &structures, &interrupt)).collect();
        for (job, found) in part.iter().zip(found) {
            match found {
                Ok((model, found)) => {
                    written += write_point(&mut files, job, &model, &found, modes)?;
                }
                Err(JobError::Interrupted) => return foreground::exit_code(JobError::Interrupted),
                // The sweep has reported the failure already.
                Err(error) => {
                    log(format_args!("no shapes at {}: {error}", in_words(job)));
                    code = exit::SOME_FAILED;
                }
            }
        }
    }
    files.finish()?;
    log(format_args!("{} written to {}", value::count(written, "mode shape"), folder.display()));
    Ok(code)
}

fn of_point(
    job: &Job,
    structures: &Structures,
    interrupt: &Interrupt,
) -> Result<(Model, Vec<Shape>), JobError> {
    if interrupt.is_raised() {
        return Err(JobError::Interrupted);
    }
    let model = Model::from_scene(&job.spec.scene, &job.spec.numerics)?;
    let found = shapes(&job.spec, &model, structures)?;
    Ok((model, found))
}

/// Writes the modes that are shown. Returns their number.
fn write_point(
    files: &mut Folder,
    job: &Job,
    model: &Model,
    shapes: &[Shape],
    modes: ShownModes,
) -> Result<usize, CliError> {
    let shortest_m = job.spec.scene.pin.extent_m().into_iter().fold(f64::INFINITY, f64::min);
    let shown = modes.of(shapes.iter().map(|(mode, _)| mode));
    for &index in &shown {
        let (mode, shape) = &shapes[index];
        let name = format!("{}_mode-{}", slug(job), index + 1);
        write_mode(files, model.mesh(), &name, mode.frequency_hz, shape, AMPLITUDE * shortest_m)?;
    }
    Ok(shown.len())
}

/// The point as part of a file's name.
fn slug(job: &Job) -> String {
    let parts: Vec<String> =
        parameters_of(job).iter().map(|(name, found)| format!("{name}-{}", value::text(found))).collect();
    value::file_name_part(&parts.join("_"))
}

/// The point in words.
fn in_words(job: &Job) -> String {
    let parts: Vec<String> = parameters_of(job).iter().map(|(name, found)| assignment(name, found)).collect();
    parts.join(", ")
}
