//! The study of a command, with changes that the file need not have.

use super::error::CliError;
use super::foreground::{parse_accuracy, parse_preset, parse_setting};
use crate::study::{Basins, Calibration, Changes, Preset};
use crate::sweep::Plan;
use std::path::PathBuf;

/// A study file and what to change of it. What is stored in the database is the changed study.
#[derive(Debug, clap::Args)]
pub(crate) struct StudyArgs {
    /// The study file, or - for standard input.
    #[arg(value_name = "STUDY")]
    pub(crate) file: PathBuf,
    /// Set a parameter of the grid or any other parameter; may be repeated. A list or a range becomes an axis of the grid:
    /// 'mu=[0.2,0.4]'.
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = parse_setting)]
    settings: Vec<(String, String)>,
    /// Take mesh, time step and detection from a preset instead of the study, whose name becomes STUDY-NAME; `--set`
    /// overrides the preset.
    #[arg(long, value_name = "NAME", value_parser = parse_preset)]
    preset: Option<Preset>,
    /// Ask for an error of μ* by the mesh, for example 1%: each job goes from mesh to mesh until it is reached, instead of the mesh of the
    /// study. `--set` can give the finest mesh.
    #[arg(long, value_name = "ERROR", value_parser = parse_accuracy, allow_hyphen_values = true)]
    accuracy: Option<(String, String)>,
    /// Instead of what the study says about further jobs, continue each of its points N times with random velocities, to find its
    /// limit cycles. The name becomes STUDY-basins.
    #[arg(long, value_name = "N", requires = "kick_m_s")]
    basins: Option<u32>,
    /// With --basins: root mean square of the velocities in m/s.
    #[arg(long = "kick", id = "kick_m_s", value_name = "SPEED", requires = "basins")]
    kick_m_s: Option<f64>,
    /// Give the study this name, so that it stands beside the one in the file.
    #[arg(long, value_name = "NAME")]
    name: Option<String>,
}

impl StudyArgs {
    /// Reads and checks the study with its changes.
    pub(crate) fn plan(&self) -> Result<Plan, CliError> {
        Ok(Plan::load_changed(&self.file, &self.changes())?)
    }

    /// Whether anything of the file is changed.
    pub(crate) fn is_changed(&self) -> bool {
        self.changes() != Changes::default()
    }

    /// Reads and checks the study of the complex modes at the points of the study.
    pub(crate) fn plan_of_modes(&self) -> Result<Plan, CliError> {
        if self.basins.is_some() {
            let message = "--basins is for runs; the modes of steady sliding have no limit cycles";
            return Err(CliError::Usage(message.to_owned()));
        }
        Ok(Plan::load_changed(&self.file, &Changes { is_of_modes: true, ..self.changes() })?)
    }

    /// Reads and checks the study of a calibration. `settings` are those of the measured points; `--set` comes after them.
    pub(crate) fn plan_of_calibration(
        &self,
        calibration: Calibration,
        settings: Vec<(String, String)>,
    ) -> Result<Plan, CliError> {
        if self.basins.is_some() {
            return Err(CliError::Usage("--basins is for `run` and `submit`".to_owned()));
        }
        let own = self.changes();
        if let Some((name, _)) =
            own.settings.iter().find(|(name, _)| settings.iter().any(|(other, _)| other == name))
        {
            return Err(CliError::Usage(format!("--set {name}: the measured points have this parameter")));
        }
        let settings = settings.into_iter().chain(own.settings.iter().cloned()).collect();
        let changes = Changes { settings, calibration: Some(calibration), ..own };
        Ok(Plan::load_changed(&self.file, &changes)?)
    }

    /// The names of the parameters that `--set` gives.
    pub(crate) fn set_names(&self) -> impl Iterator<Item = &str> {
        self.settings.iter().map(|(name, _)| name.as_str())
    }

    fn changes(&self) -> Changes {
        let (name, settings) =
            (self.name.clone(), self.accuracy.iter().chain(&self.settings).cloned().collect());
        let basins = self.basins.zip(self.kick_m_s).map(|(kicks, kick_m_s)| Basins { kicks, kick_m_s });
        Changes { name, preset: self.preset, settings, is_of_modes: false, basins, calibration: None }
    }
}
