//! What was simulated: drawings of the scene and all inputs of a study's jobs, for its pages.
//!
//! ```text
//! jobs ──► survey: the values of every input and derived quantity ──► lines: as people write them
//!                                                              └────► pin, track: drawings
//! ```

mod colours;
mod derived;
mod lines;
mod pin;
mod surface;
mod survey;
mod track;
mod view;

use super::error::SweepError;
use crate::publish::{Sheet, SheetGroup};
use crate::queue::Queue;
use crate::report::JobRow;
use crate::spec::JobSpec;
use crate::study::{Parameter, Study};
use survey::Survey;

/// What was simulated in a single job. `origin` says where the value of a parameter comes from, in a word that may be
/// empty.
pub fn sheet_of_job(spec: &JobSpec, origin: impl Fn(&Parameter) -> &'static str) -> Sheet {
    let mut survey = Survey::default();
    survey.add(spec);
    sheet(&survey, &[], origin)
}

/// What was simulated in the jobs of studies, from their stored specifications; none if they have no jobs. `definitions` are
/// the studies as submitted.
pub(super) async fn read(
    queue: &mut Queue,
    studies: &[String],
    definitions: &[Study],
    rows: &[JobRow],
) -> Result<Option<Sheet>, SweepError> {
    let mut survey = Survey::default();
    for study in studies {
        super::rows::for_each_spec(queue, study, |spec| survey.add(spec)).await?;
    }
    if survey.first.is_none() {
        return Ok(None);
    }
    // Studies may differ in who gave a value. Then, and if this version cannot read a study, nothing is said.
    let is_known = definitions.len() == studies.len();
    let origin = |parameter: &Parameter| {
        let mut origins = definitions.iter().map(|study| study.origin(parameter).name());
        let first = origins.next().filter(|_| is_known);
        first.filter(|first| origins.all(|other| other == *first)).unwrap_or("")
    };
    Ok(Some(sheet(&survey, rows, origin)))
}

fn sheet(survey: &Survey, rows: &[JobRow], origin: impl Fn(&Parameter) -> &'static str) -> Sheet {
    let mut groups: Vec<SheetGroup> = lines::of_inputs(survey, origin);
    groups.push(lines::of_derived(survey, rows));
    let drawings = survey.first.as_ref().map(|spec| vec![pin::draw(spec, survey), track::draw(spec, survey)]);
    Sheet { drawings: drawings.unwrap_or_default(), groups }
}
