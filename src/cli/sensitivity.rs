//! `tribosweep sensitivity`: how much each parameter of a study decides.

use super::error::CliError;
use super::output::{log, print};
use super::report::OutFolder;
use super::rows;
use crate::exit;
use crate::publish::Folder;
use crate::queue::Location;
use crate::report::{Scalar, sensitivity};

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
        Scalar::find(name).ok_or_else(|| {
            CliError::Refused(format!(
                "--of {name}: no such quantity; expected a column of `tribosweep export` that is a number, such as mu_star"
            ))
        })
    };
    let of = args.of.iter().map(scalar).collect::<Result<Vec<_>, _>>()?;
    let (names, rows) = rows::of_studies(&args.studies, db)?;
    let found = sensitivity::sensitivities(&rows, &of);
    if found.iter().all(|one| one.parameters.is_empty()) {
        let title = names.join(", ");
        return Err(CliError::Refused(format!(
            "{title}: no parameter varies between the jobs that are done; run them first, or vary more"
        )));
    }
    let text = sensitivity::markdown(&found);
    print(&text)?;
    let path = args.out.of(&names[0]);
    let mut folder = Folder::create(&path, "sensitivity")?;
    folder.write_text("sensitivity.md", &text)?;
    folder.write_text("sensitivity.csv", &sensitivity::csv(&found))?;
    folder.finish(|_| false)?;
    log(format_args!("indices written to {}", path.display()));
    Ok(exit::SUCCESS)
}
