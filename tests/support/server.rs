//! Databases on a PostgreSQL server, where there is one.

use std::future::Future;
use std::sync::atomic::{AtomicU32, Ordering};

use sqlx::postgres::PgConnectOptions;
use sqlx::{ConnectOptions, PgConnection};

use crate::tools;

/// The URL of a PostgreSQL server where databases can be created and dropped (`scripts/postgres.sh start FOLDER`
/// prints one).
pub const SERVER: &str = "TRIBOSWEEP_TEST_POSTGRES";

/// An empty database, dropped in the end.
pub struct ServerDatabase {
    server: String,
    name: String,
}

impl ServerDatabase {
    /// None, and a message, where there is no server.
    pub fn new() -> Option<Self> {
        static NUMBER: AtomicU32 = AtomicU32::new(0);
        if cfg!(not(feature = "postgres")) {
            tools::missing(
                "this tribosweep is built without PostgreSQL",
                "build it with the feature `postgres`",
            );
            return None;
        }
        let Ok(server) = std::env::var(SERVER) else {
            tools::missing(
                &format!("{SERVER} does not name a PostgreSQL server"),
                "`scripts/postgres.sh start FOLDER` starts one and prints its URL",
            );
            return None;
        };
        let name = format!("test_{}_{}", std::process::id(), NUMBER.fetch_add(1, Ordering::Relaxed));
        run_on(&server, format!("CREATE DATABASE {name}"));
        Some(Self { server, name })
    }

    /// Its URL, without encryption: an encrypted connection takes a tenth of a second to make.
    pub fn url(&self) -> String {
        self.encrypted_url() + "?sslmode=disable"
    }

    /// Its URL as users have it: with encryption if the server has a certificate.
    pub fn encrypted_url(&self) -> String {
        let (server, _) = self.server.rsplit_once('/').expect("postgres://USER@HOST/DATABASE");
        format!("{server}/{}", self.name)
    }

    /// A connection past the program.
    pub async fn raw(&self) -> PgConnection {
        let options: PgConnectOptions = self.url().parse().unwrap();
        options.options([("search_path", "tribosweep")]).connect().await.unwrap()
    }
}

impl Drop for ServerDatabase {
    fn drop(&mut self) {
        run_on(&self.server, format!("DROP DATABASE {} WITH (FORCE)", self.name));
    }
}

fn run_on(url: &str, statement: String) {
    let run = async |url: String| {
        let options: PgConnectOptions = url.parse().unwrap();
        let mut connection = options.connect().await.unwrap();
        sqlx::raw_sql(sqlx::AssertSqlSafe(statement)).execute(&mut connection).await.unwrap();
    };
    let url = url.to_owned();
    // Whoever asks may be in a runtime already.
    std::thread::spawn(move || block_on(run(url))).join().unwrap();
}

/// Runs a future on a runtime of its own.
pub fn block_on<F: Future>(future: F) -> F::Output {
    tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap().block_on(future)
}
