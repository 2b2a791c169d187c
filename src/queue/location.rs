use std::ffi::OsString;
use std::fmt;
use std::path::{Path, PathBuf};

/// Where a database is: a file of `SQLite`'s, or a PostgreSQL server.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Location {
    /// A file.
    File(PathBuf),
    /// A server.
    Server(Server),
}

/// A PostgreSQL database by its URL. It may hold a password, which is never shown.
#[derive(Clone, PartialEq, Eq)]
pub struct Server {
    url: String,
}

/// How the URL of a PostgreSQL database begins, before `://`.
const SCHEMES: [&str; 2] = ["postgres", "postgresql"];

impl Location {
    /// What a user wrote: a URL where there is a `://` in it, or else a path.
    pub fn parse(text: OsString) -> Self {
        match text.to_str() {
            // Also of an unknown kind: who refuses it must not show its password, and does so when it is opened.
            Some(url) if url.contains("://") => Self::Server(Server { url: url.to_owned() }),
            _ => Self::File(text.into()),
        }
    }

    /// The path, where it is a file's.
    pub fn path(&self) -> Option<&Path> {
        match self {
            Self::File(path) => Some(path),
            Self::Server(_) => None,
        }
    }
}

impl Server {
    /// The whole URL.
    pub fn url(&self) -> &str {
        &self.url
    }

    /// Whether it is PostgreSQL's.
    ///
    /// # Errors
    /// If it is not, what would be right.
    pub fn check(&self) -> Result<(), String> {
        let (scheme, _) = self.parts();
        if SCHEMES.iter().any(|known| known.eq_ignore_ascii_case(scheme)) {
            return Ok(());
        }
        Err(format!(
            "no database is known that `{scheme}://` names; expected a path, or postgres://USER@HOST/DATABASE"
        ))
    }

    /// Whether the URL holds a password.
    pub fn has_password(&self) -> bool {
        let (_, rest) = self.parts();
        has_password_in_front(rest) || pairs(rest).any(is_password)
    }

    /// The URL without the password.
    pub fn without_password(&self) -> String {
        let (scheme, rest) = self.parts();
        let mut shown = rest.to_owned();
        if has_password_in_front(rest)
            && let (Some((user, _)), Some((_, host))) = (rest.split_once(':'), rest.rsplit_once('@'))
        {
            shown = format!("{user}@{host}");
        }
        if pairs(&shown).any(is_password) {
            let others: Vec<&str> = pairs(&shown).filter(|pair| !is_password(pair)).collect();
            let front = shown.split('?').next().unwrap_or_default();
            let mark = if others.is_empty() { "" } else { "?" };
            shown = format!("{front}{mark}{}", others.join("&"));
        }
        format!("{scheme}://{shown}")
    }

    /// The scheme, and what follows `://`.
    fn parts(&self) -> (&str, &str) {
        self.url.split_once("://").unwrap_or_default()
    }
}

/// The settings behind the question mark.
fn pairs(rest: &str) -> impl Iterator<Item = &str> {
    rest.split_once('?').map_or("", |(_, query)| query).split('&').filter(|pair| !pair.is_empty())
}

fn is_password(pair: &str) -> bool {
    pair.to_ascii_lowercase().starts_with("password=")
}

/// Whether there is one before the host: `user:password@host`.
fn has_password_in_front(rest: &str) -> bool {
    let authority = rest.split(['/', '?', '#']).next().unwrap_or(rest);
    // One that was not encoded may hold these characters, too; what is all digits then is a port.
    let is_port = |text: &str| {
        text.split(['/', '?', '#']).next().is_some_and(|it| it.bytes().all(|c| c.is_ascii_digit()))
    };
    authority.rsplit_once('@').is_some_and(|(user, _)| user.contains(':'))
        || rest
            .rsplit_once('@')
            .is_some_and(|(before, _)| before.split_once(':').is_some_and(|(_, after)| !is_port(after)))
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(path) => path.display().fmt(f),
            Self::Server(server) => server.fmt(f),
        }
    }
}

impl fmt::Display for Server {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.without_password())
    }
}

impl fmt::Debug for Server {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl From<&Path> for Location {
    fn from(path: &Path) -> Self {
        Self::File(path.into())
    }
}

impl From<PathBuf> for Location {
    fn from(path: PathBuf) -> Self {
        Self::File(path)
    }
}

#[cfg(test)]
mod tests {
    use super::Location;

    /// Protects: what begins like a server's URL is one, another scheme is not taken for a file, and all else is a file.
    #[test]
    fn servers_and_files_are_told_apart() {
        for url in ["postgres://ada@db/sweeps", "postgresql://db", "POSTGRES://db"] {
            let Location::Server(server) = Location::parse(url.into()) else { panic!("{url}") };
            assert_eq!(server.check(), Ok(()));
        }
        for path in ["tribosweep.db", "/data/postgres/x.db", "postgres:x"] {
            assert_eq!(Location::parse(path.into()), Location::File(path.into()));
        }
        let Location::Server(server) = Location::parse("mysql://ada:secret@db/x".into()) else { panic!() };
        let error = server.check().unwrap_err();
        assert!(error.contains("mysql://") && error.contains("postgres://"), "{error}");
        assert!(!error.contains("secret"), "{error}");
    }

    /// Protects: no message shows a password, wherever in a URL it is.
    #[test]
    fn passwords_are_not_shown() {
        for (url, shown) in [
            ("postgres://ada:secret@db:5433/sweeps", "postgres://ada@db:5433/sweeps"),
            ("postgres://ada:sec@ret@db/sweeps", "postgres://ada@db/sweeps"),
            ("postgres://ada:s/e@c?secret@db/sweeps", "postgres://ada@db/sweeps"),
            ("postgres://ada:1@db/sweeps", "postgres://ada@db/sweeps"),
            ("postgres://db/x?a=b&PASSWORD=secret", "postgres://db/x?a=b"),
            ("postgres://ada@db:5432/x?options=a@b", "postgres://ada@db:5432/x?options=a@b"),
            ("postgres://db:5432/x?options=a@b", "postgres://db:5432/x?options=a@b"),
            ("postgres://db/sweeps?user=ada&password=secret", "postgres://db/sweeps?user=ada"),
            ("postgres://db?password=secret", "postgres://db"),
            ("postgres://ada@db/sweeps?sslmode=require", "postgres://ada@db/sweeps?sslmode=require"),
        ] {
            let Location::Server(server) = Location::parse(url.into()) else { panic!("{url}") };
            assert_eq!(server.to_string(), shown);
            assert_eq!(server.has_password(), url != shown);
            assert!(!format!("{server:?}").contains("secret"));
            assert_eq!(server.url(), url);
        }
    }
}
