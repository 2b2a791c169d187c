//! `tribosweep sensitivity`: how much each parameter of a study decides.

use super::error::CliError;
use super::output::{log, print};
use super::report::OutFolder;
use super::rows;
use crate::exit;
use crate::publish::value::count;
use crate::publish::{Folder, html, markdown};
use crate::queue::Location;
use crate::report::{Scalar, sensitivity};
use crate::sweep::{self, Purpose, ReportRequest};

/// Arguments of `sensitivity`.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Names or files of the studies; the jobs of several are taken together.
    #[arg(required = true)]
    studies: Vec<String>,
    /// The quantities: columns of the export that are numbers.
    #[arg(long, value_delimiter = ',', value_name = "NAME", default_values = ["mu_star", "frequency_hz"])]
    of: Vec<String>,
    #[command(flatten)]
    out: OutFolder,
}

/// Computes the indices of the finished jobs, prints the tables and writes the files.
pub(crate) fn run(args: &Args, db: &Location) -> Result<u8, CliError> {
    let scalar = |name: &String| {
        Scalar::find(name).ok_or_else(|| CliError::Refused(sweep::no_such_quantity("--of", name).to_string()))
    };
    let of = args.of.iter().map(scalar).collect::<Result<Vec<_>, _>>()?;
    let (names, rows) = rows::of_studies(&args.studies, db)?;
    let request = ReportRequest { studies: names.clone(), ..ReportRequest::default() };
    let is_morris = sweep::with_queue(db, Purpose::Read, async |queue| request.is_morris(queue).await)?;
    let found = sensitivity::sensitivities(&rows, &of, is_morris);
    if found.iter().all(|one| one.parameters.is_empty()) {
        let title = names.join(", ");
        return Err(CliError::Refused(format!(
            "{title}: no parameter varies between the jobs that are done; run them first, or vary more"
        )));
    }
    print(&sensitivity::markdown(&found))?;
    let path = args.out.of(&names[0]);
    let mut folder = Folder::create(&path, "sensitivity")?;
    let page = sensitivity::page(&found, &names.join(", "));
    folder.write_text("sensitivity.html", &html::of_page(&page))?;
    folder.write_text("sensitivity.md", &markdown::of_page(&page))?;
    folder.write_table(&sensitivity::indices_table(&found))?;
    let (points, left_out) = sensitivity::points_table(&rows, &of);
    folder.write_table(&points)?;
    folder.finish()?;
    if left_out > 0 {
        log(format_args!(
            "{} without a value left out of sensitivity_points.csv",
            count(left_out as u64, "job")
        ));
    }
    log(format_args!("indices written to {}", path.display()));
    Ok(exit::SUCCESS)
}
