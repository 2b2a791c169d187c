//! The settings for Slurm and the database. Invalid values are refused here: Slurm would refuse them only after the study
//! has been planned.

use crate::cli::error::CliError;
use crate::queue::Location;

/// Tasks stop two minutes before their time limit, and Slurm's signal may come a minute earlier. With a shorter limit they
/// would be stopped again and again without any progress.
const SHORTEST_MINUTES: u64 = 5;

/// Reads names that are separated by commas.
pub(crate) fn names(text: &str) -> Result<String, String> {
    let usable = |name: &str| {
        let allowed = |c: char| c.is_ascii_alphanumeric() || "_-.+@".contains(c);
        !name.is_empty() && !name.starts_with('-') && name.chars().all(allowed)
    };
    if text.split(',').all(usable) {
        return Ok(text.to_owned());
    }
    Err("expected a name of letters, digits, _, -, . , + and @, or several separated by commas".to_owned())
}

/// Reads an amount of memory.
pub(crate) fn memory(text: &str) -> Result<String, String> {
    let number = text.strip_suffix(['K', 'M', 'G', 'T', 'k', 'm', 'g', 't']).unwrap_or(text);
    if !number.is_empty() && number.bytes().all(|c| c.is_ascii_digit()) {
        return Ok(text.to_owned());
    }
    Err("expected a whole number of megabytes, or a number with the unit K, M, G or T, such as 500M or 2G"
        .to_owned())
}

/// Reads a time limit in one of Slurm's six formats.
pub(crate) fn time_limit(text: &str) -> Result<String, String> {
    if ["UNLIMITED", "INFINITE"].iter().any(|word| word.eq_ignore_ascii_case(text)) {
        return Ok(text.to_owned());
    }
    let seconds = seconds(text).ok_or_else(|| {
        "expected a time as Slurm writes it: minutes (30), minutes:seconds (30:00), hours:minutes:seconds (4:00:00), \
         days-hours (1-12), days-hours:minutes (1-12:30), days-hours:minutes:seconds (1-12:30:00), or UNLIMITED"
            .to_owned()
    })?;
    if seconds < SHORTEST_MINUTES * 60 {
        return Err(format!(
            "too short: tasks stop two to three minutes before their time limit, to continue in another time slot; \
             expected at least {SHORTEST_MINUTES} minutes, better hours"
        ));
    }
    Ok(text.to_owned())
}

fn seconds(text: &str) -> Option<u64> {
    let (days, clock) = text.split_once('-').map_or((None, text), |(days, clock)| (Some(days), clock));
    let number = |text: &str| {
        let is_number = !text.is_empty() && text.len() <= 9 && text.bytes().all(|c| c.is_ascii_digit());
        is_number.then(|| text.parse::<u64>().ok()).flatten()
    };
    let parts: Option<Vec<u64>> = clock.split(':').map(number).collect();
    let within_a_day = match (days, parts?.as_slice()) {
        (Some(_), &[hours]) => hours * 3600,
        (Some(_), &[hours, minutes]) => hours * 3600 + minutes * 60,
        (_, &[hours, minutes, seconds]) => hours * 3600 + minutes * 60 + seconds,
        (None, &[minutes]) => minutes * 60,
        (None, &[minutes, seconds]) => minutes * 60 + seconds,
        _ => return None,
    };
    Some(days.map_or(Some(0), number)? * 86_400 + within_a_day)
}

/// The database of the workers.
#[derive(Debug)]
pub(crate) enum Database {
    /// The URL of a PostgreSQL database that all workers share.
    Shared(String),
    /// Each worker has a SQLite file on the local disk of its node. At the end these shards are merged into the file with
    /// this name.
    Shards(String),
}

impl Database {
    /// Whether all workers share it.
    pub(crate) fn is_shared(&self) -> bool {
        matches!(self, Self::Shared(_))
    }

    /// The database that `--db` names.
    pub(crate) fn of(db: &Location) -> Result<Self, CliError> {
        match db {
            // The message does not show the URL: it contains a password.
            Location::Server(server) if server.has_password() => Err(CliError::Usage(
                "the URL of the database has a password, and the scripts are files that others may read; leave it \
                 out of the URL, and put it into ~/.pgpass (a line host:port:database:user:password, chmod 600) or \
                 into the environment as PGPASSWORD before you submit"
                    .to_owned(),
            )),
            Location::Server(server) => {
                server.check_scheme().map_err(|reason| CliError::Usage(format!("{db}: {reason}")))?;
                Ok(Self::Shared(server.url().to_owned()))
            }
            Location::File(path) => {
                let name = path.file_name().and_then(|name| name.to_str());
                let name = name.ok_or_else(|| {
                    CliError::Usage(format!("--db {db}: expected the name of a file, in UTF-8, or a URL"))
                })?;
                Ok(Self::Shards(name.to_owned()))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Protects: every time format of Slurm is accepted and has the right value; other texts are refused.
    #[test]
    fn times() {
        for (text, expected) in [
            ("30", 1800),
            ("30:30", 1830),
            ("4:00:00", 14_400),
            ("1-12", 129_600),
            ("1-12:30", 131_400),
            ("1-12:30:10", 131_410),
        ] {
            assert_eq!(seconds(text), Some(expected), "{text}");
        }
        for text in ["", "abc", "1h", "-1", "1-", "1:2:3:4", "1-2:3:4:5", "1 2", "1.5", "+5", "9999999999"] {
            assert_eq!(seconds(text), None, "{text}");
        }
        assert!(time_limit("4").unwrap_err().contains("at least 5 minutes"));
        assert!(time_limit("unlimited").is_ok() && time_limit("5").is_ok());
    }

    /// Protects: texts that Slurm or a shell would interpret are refused as names and as amounts of memory.
    #[test]
    fn names_and_memory() {
        for text in ["main", "main,low", "gpu-a100.v2", "user@site"] {
            assert_eq!(names(text).unwrap(), text);
        }
        for text in ["", "a b", "a,,b", "--x", "$(id)", "a;b", "a\nb", "'"] {
            assert!(names(text).is_err(), "{text}");
        }
        assert!(["0", "500", "2G", "500m"].iter().all(|text| memory(text).is_ok()));
        assert!(["", "G", "2 G", "2GB", "-1", "1.5G"].iter().all(|text| memory(text).is_err()));
    }
}
