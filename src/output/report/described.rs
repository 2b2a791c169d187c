//! The columns of all tables of reports, for the page of columns.

use super::columns::{any_quantity, columns, selected};
use super::figure::{DataFile, Plot, RESIDUALS, RUN_TIMES};
use super::{
    calibration, comparison_files, growth, pareto, sensitivity, spectra, stability, tables, windows,
};
use crate::publish::table::{FileColumns, Head};

/// The columns of all tables of reports but the export, for the page of columns. Parameters of a study follow.
pub fn columns_of_files() -> Vec<FileColumns> {
    let of_chains = [
        Head::new("direction", "", "way along the parameter of `continue`: up or down"),
        Head::new("kick", "", "number of the kick of a job that continues another one"),
        Head::new("source", "", "study or file, in reports of several sources"),
    ];
    let further = "A line is a job, with the columns of the export. Jobs that continue others, and reports of several sources, have these, too. \
                   So have tables of a quantity and tables of points.";
    let jobs = FileColumns { files: vec!["jobs.csv".to_owned()], lines: further, heads: of_chains.into() };
    let mut data = Vec::<FileColumns>::new();
    for DataFile { stem, columns } in Plot::ALL.map(Plot::data).into_iter().chain([RESIDUALS, RUN_TIMES]) {
        let file = format!("{stem}.csv");
        if data.iter().all(|known| known.files[0] != file) {
            let heads = selected(&columns).map(|own| own.column.head.clone()).collect();
            data.push(FileColumns { files: vec![file], lines: "A line is a job of a figure.", heads });
        }
    }
    let mut heads: Vec<Head> = selected(&columns(["regime"])).map(|own| own.column.head.clone()).collect();
    heads.push(any_quantity());
    data.push(FileColumns {
        files: vec!["QUANTITY_points.csv".to_owned()],
        lines: "A line is a job of a figure.",
        heads,
    });
    [jobs, tables::described()]
        .into_iter()
        .chain(data)
        .chain([comparison_files::described(), windows::described(), spectra::described()])
        .chain(growth::described())
        .chain(calibration::described())
        .chain(sensitivity::described())
        .chain(pareto::described())
        .chain(stability::described())
        .collect()
}
