use std::ffi::OsString;
use std::fmt;
use std::path::{Path, PathBuf};

use url::{Url, form_urlencoded};

/// Where a database is: a `SQLite` file or a PostgreSQL server.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Location {
    /// A file.
    File(PathBuf),
    /// A server.
    Server(Server),
}

/// The URL of a PostgreSQL database. It may contain a password, which is never shown.
#[derive(Clone, PartialEq, Eq)]
pub struct Server {
    url: String,
}

/// The schemes of PostgreSQL's URLs.
const SCHEMES: [&str; 2] = ["postgres", "postgresql"];

impl Location {
    /// Parses what a user wrote: text with `://` is a URL, all else is a path.
    pub fn parse(text: OsString) -> Self {
        match text.to_str() {
            // A URL of another kind is refused when it is opened. It must not be taken for a path, because messages
            // show paths and the URL may contain a password.
            Some(url) if url.contains("://") => Self::Server(Server { url: url.to_owned() }),
            _ => Self::File(text.into()),
        }
    }

    /// The path, if the database is a file.
    pub fn path(&self) -> Option<&Path> {
        match self {
            Self::File(path) => Some(path),
            Self::Server(_) => None,
        }
    }
}

impl Server {
    /// The URL with its password.
    pub fn url(&self) -> &str {
        &self.url
    }

    /// Checks that the scheme is PostgreSQL's.
    ///
    /// # Errors
    /// A text that names the schemes that are possible.
    pub fn check_scheme(&self) -> Result<(), String> {
        let (scheme, _) = self.url.split_once("://").unwrap_or_default();
        if SCHEMES.iter().any(|known| known.eq_ignore_ascii_case(scheme)) {
            return Ok(());
        }
        Err(format!(
            "`{scheme}://` is not a known database; expected a path, or postgres://USER@HOST/DATABASE"
        ))
    }

    /// Whether the URL contains a password.
    pub fn has_password(&self) -> bool {
        match Url::parse(&self.url) {
            Ok(url) => url.password().is_some() || pairs(&url).any(is_password),
            Err(_) => is_guarded(&self.url) || self.url.to_ascii_lowercase().contains("password="),
        }
    }

    /// The URL without passwords.
    fn without_password(&self) -> String {
        match Url::parse(&self.url) {
            // The parser took a part of the password for the host.
            Ok(url) if url.password().is_some() && has_at_sign_after_authority(&self.url) => {
                strip_unparsable(&self.url)
            }
            Ok(url) if self.has_password() => strip_passwords(url).into(),
            Ok(_) => self.url.clone(),
            Err(_) => strip_unparsable(&self.url),
        }
    }
}

/// The settings after the question mark, encoded as they are.
fn pairs(url: &Url) -> impl Iterator<Item = &str> {
    url.query().unwrap_or_default().split('&')
}

fn is_password(pair: &str) -> bool {
    form_urlencoded::parse(pair.as_bytes()).any(|(name, _)| name.eq_ignore_ascii_case("password"))
}

fn strip_passwords(mut url: Url) -> Url {
    // This fails for a URL without a host only, which has no password here either.
    let _ = url.set_password(None);
    let others: Vec<&str> = pairs(&url).filter(|pair| !is_password(pair)).collect();
    let others = others.join("&");
    url.set_query((!others.is_empty()).then_some(others.as_str()));
    // The rest of a password with an unencoded `#`.
    url.set_fragment(None);
    url
}

/// As [`strip_passwords`], for text that is not a valid URL, for instance because its password has unencoded
/// characters. Everything between the first `:` and the last `@` may belong to the password, and so may all settings.
fn strip_unparsable(text: &str) -> String {
    let Some((scheme, rest)) = text.split_once("://") else { return String::new() };
    if is_guarded(text)
        && let (Some((user, _)), Some((_, host))) = (rest.split_once(':'), rest.rsplit_once('@'))
    {
        let host = host.split('?').next().unwrap_or_default();
        return format!("{scheme}://{user}@{host}");
    }
    format!("{scheme}://{}", rest.split('?').next().unwrap_or_default())
}

/// Whether an `@` follows the part of a URL that ends at the first `/`, `?` or `#`. After a password, the text up to that
/// `@` may belong to the password: an unencoded `@` and then one of these characters still make a valid URL.
fn has_at_sign_after_authority(text: &str) -> bool {
    let rest = text.split_once("://").map_or(text, |(_, rest)| rest);
    rest.split_once(['/', '?', '#']).is_some_and(|(_, after)| after.contains('@'))
}

/// Whether text that is not a valid URL has a `:` before an `@`.
fn is_guarded(text: &str) -> bool {
    let rest = text.split_once("://").map_or(text, |(_, rest)| rest);
    rest.rsplit_once('@').is_some_and(|(user, _)| user.contains(':'))
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

    /// Protects: text with `://` is a URL, a URL with another scheme is refused and not taken for a path, and all else
    /// is a path.
    #[test]
    fn servers_and_files_are_told_apart() {
        for url in ["postgres://ada@db/sweeps", "postgresql://db", "POSTGRES://db"] {
            let Location::Server(server) = Location::parse(url.into()) else { panic!("{url}") };
            assert_eq!(server.check_scheme(), Ok(()));
        }
        for path in ["tribosweep.db", "/data/postgres/x.db", "postgres:x"] {
            assert_eq!(Location::parse(path.into()), Location::File(path.into()));
        }
        let Location::Server(server) = Location::parse("mysql://ada:secret@db/x".into()) else { panic!() };
        let error = server.check_scheme().unwrap_err();
        assert!(error.contains("mysql://") && error.contains("postgres://"), "{error}");
        assert!(!error.contains("secret"), "{error}");
    }

    /// Protects: no message shows a password, wherever it is in the URL, and even if the URL is not valid.
    #[test]
    fn passwords_are_not_shown() {
        for (url, shown) in [
            ("postgres://ada:secret@db:5433/sweeps", "postgres://ada@db:5433/sweeps"),
            ("postgres://ada:sec@ret@db/sweeps", "postgres://ada@db/sweeps"),
            ("postgres://ada:s/e@c?secret@db/sweeps", "postgres://ada@db/sweeps"),
            ("postgres://ada:sec@ret/secret@db/sweeps", "postgres://ada@db/sweeps"),
            ("postgres://ada:sec@ret?secret@db/sweeps", "postgres://ada@db/sweeps"),
            ("postgres://ada:sec@ret#secret@db/sweeps", "postgres://ada@db/sweeps"),
            ("postgres://ada:1@db/sweeps", "postgres://ada@db/sweeps"),
            ("postgres://db/x?a=b&PASSWORD=secret", "postgres://db/x?a=b"),
            ("postgres://ada@db:5432/x?options=a@b", "postgres://ada@db:5432/x?options=a@b"),
            ("postgres://db:5432/x?options=a@b", "postgres://db:5432/x?options=a@b"),
            ("postgres://db/sweeps?user=ada&password=secret", "postgres://db/sweeps?user=ada"),
            ("postgres://db?password=secret", "postgres://db"),
            ("postgres://ada@db/sweeps?sslmode=require", "postgres://ada@db/sweeps?sslmode=require"),
            ("postgres://ada@db/x?%70assword=secret&sslmode=require", "postgres://ada@db/x?sslmode=require"),
            ("postgres://ada@db/x?password=1#secret", "postgres://ada@db/x"),
            ("postgres://ada:secret@db:port/x?password=secret", "postgres://ada@db:port/x"),
            ("postgres://db:port/x?password=secret", "postgres://db:port/x"),
            ("postgres://ada:secret@[::1]:5432/x", "postgres://ada@[::1]:5432/x"),
            ("odd scheme://ada:secret@db", "odd scheme://ada@db"),
        ] {
            let Location::Server(server) = Location::parse(url.into()) else { panic!("{url}") };
            assert_eq!(server.to_string(), shown);
            assert_eq!(server.has_password(), url != shown);
            assert!(!format!("{server:?}").contains("secret"));
            assert_eq!(server.url(), url);
        }
    }
}
