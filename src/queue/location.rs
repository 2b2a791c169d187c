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

/// How the URL of a PostgreSQL database begins.
const SCHEMES: [&str; 2] = ["postgres://", "postgresql://"];

impl Location {
    /// A path, or a URL that begins with `postgres://` or `postgresql://`.
    ///
    /// # Errors
    /// For a URL of anything else, in words.
    pub fn parse(text: OsString) -> Result<Self, String> {
        let Some(url) = text.to_str().filter(|text| text.contains("://")) else {
            return Ok(Self::File(text.into()));
        };
        if SCHEMES.iter().any(|scheme| url.starts_with(scheme)) {
            return Ok(Self::Server(Server { url: url.to_owned() }));
        }
        let scheme = url.split("://").next().unwrap_or_default();
        Err(format!(
            "no database is known that `{scheme}://` names; expected a path, or postgres://USER@HOST/DATABASE"
        ))
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

    /// Whether the URL holds a password.
    pub fn has_password(&self) -> bool {
        self.without_password() != self.url
    }

    /// The URL without the password.
    pub fn without_password(&self) -> String {
        let Some((scheme, rest)) = self.url.split_once("://") else { return self.url.clone() };
        let (rest, query) = rest.split_once('?').map_or((rest, None), |(rest, query)| (rest, Some(query)));
        let authority_end = rest.find('/').unwrap_or(rest.len());
        let (authority, path) = rest.split_at(authority_end);
        let authority = match authority.rsplit_once('@') {
            Some((user, host)) => format!("{}@{host}", user.split(':').next().unwrap_or_default()),
            None => authority.to_owned(),
        };
        let mut url = format!("{scheme}://{authority}{path}");
        let shown = |pair: &&str| !pair.starts_with("password=");
        let query: Vec<&str> = query.into_iter().flat_map(|query| query.split('&')).filter(shown).collect();
        if !query.is_empty() {
            url = format!("{url}?{}", query.join("&"));
        }
        url
    }
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
        for url in ["postgres://ada@db/sweeps", "postgresql://db"] {
            assert!(matches!(Location::parse(url.into()), Ok(Location::Server(_))), "{url}");
        }
        for path in ["tribosweep.db", "/data/postgres/x.db", "postgres:x"] {
            assert_eq!(Location::parse(path.into()), Ok(Location::File(path.into())));
        }
        let error = Location::parse("mysql://db/x".into()).unwrap_err();
        assert!(error.contains("mysql://") && error.contains("postgres://"), "{error}");
    }

    /// Protects: no message shows a password, wherever in a URL it is.
    #[test]
    fn passwords_are_not_shown() {
        for (url, shown) in [
            ("postgres://ada:secret@db:5433/sweeps", "postgres://ada@db:5433/sweeps"),
            ("postgres://ada:sec@ret@db/sweeps", "postgres://ada@db/sweeps"),
            ("postgres://db/sweeps?user=ada&password=secret", "postgres://db/sweeps?user=ada"),
            ("postgres://db?password=secret", "postgres://db"),
            ("postgres://ada@db/sweeps?sslmode=require", "postgres://ada@db/sweeps?sslmode=require"),
        ] {
            let Ok(Location::Server(server)) = Location::parse(url.into()) else { panic!("{url}") };
            assert_eq!(server.to_string(), shown);
            assert_eq!(server.has_password(), url != shown);
            assert!(!format!("{server:?}").contains("secret"));
            assert_eq!(server.url(), url);
        }
    }
}
