//! What Slurm and the database are told. What cannot be meant is refused here: Slurm would say so when the study is
//! planned already.

use crate::cli::error::CliError;
use crate::queue::Location;

/// Tasks stop two minutes before their time limit, of which Slurm may be a minute early: in less than this they would
/// be stopped again and again before they get anywhere.
const SHORTEST_MINUTES: u64 = 5;

/// Reads names with commas between them.
pub fn names(text: &str) -> Result<String, String> {
    let usable = |name: &str| {
        let allowed = |c: char| c.is_ascii_alphanumeric() || "_-.+@".contains(c);
        !name.is_empty() && !name.starts_with('-') && name.chars().all(allowed)
    };
    if text.split(',').all(usable) {
        return Ok(text.to_owned());
    }
    Err("expected a name of letters, digits, _, -, . , + and @, or several with commas between them"
        .to_owned())
}

/// Reads an amount of memory.
pub fn memory(text: &str) -> Result<String, String> {
    let number = text.strip_suffix(['K', 'M', 'G', 'T', 'k', 'm', 'g', 't']).unwrap_or(text);
    if !number.is_empty() && number.bytes().all(|c| c.is_ascii_digit()) {
        return Ok(text.to_owned());
    }
    Err("expected a whole number of megabytes, or one with K, M, G or T behind it, such as 500M or 2G"
        .to_owned())
}

/// Reads a time limit in one of Slurm's six ways of writing it.
pub fn time_limit(text: &str) -> Result<String, String> {
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
            "too short: tasks stop two to three minutes before their time limit, to go on in another time slot; \
             expected at least {SHORTEST_MINUTES} minutes, and better hours"
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

/// Where the workers' jobs are.
#[derive(Debug)]
pub enum Database {
    /// In one PostgreSQL database that all workers share, by its URL.
    Shared(String),
    /// In a SQLite file a worker on its node's own disk; at the end they become the file with this name.
    Shards(String),
}

impl Database {
    /// What `--db` asks for.
    pub fn of(db: &Location) -> Result<Self, CliError> {
        match db {
            // Not shown: what is refused is a secret.
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

    /// Protects: every way in which Slurm writes a time is taken, with its meaning; others are not.
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

    /// Protects: what Slurm or a shell would read as something else is no name and no amount of memory.
    #[test]
    fn words() {
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
