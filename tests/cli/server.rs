//! The commands on a PostgreSQL server. The tests are skipped without a server.
#![cfg(unix)]

use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, OnceLock};

use serde_json::{Value, json};

use crate::cli::support::{Folder, LONG_JOBS, long, rows, small, stderr, stdout, wait, without_wall_times};
use crate::server::{ServerDatabase, block_on};
use crate::tools;

/// A folder with a study, and the export of its run in a file.
fn prepared(study: &Value) -> (Folder, String) {
    let folder = Folder::with("study", study);
    folder.ok("run study.json --db file.db --out file");
    let export = folder.ok("export study --db file.db");
    (folder, export)
}

/// Protects: every command does the same with a file and with a server: results, tables, figures and export are equal
/// except for run times, and copies in both directions are equal to the last byte.
#[test]
fn every_command_works_on_a_server() {
    let Some(database) = ServerDatabase::new() else { return };
    let url = database.url();
    let study = small(&json!({ "mu": [0.2, 0.3, 0.4], "omega_rpm": [5, 20] }));
    let (folder, in_a_file) = prepared(&study);
    folder.ok(&format!("submit study.json --db {url}"));
    assert!(folder.ok(&format!("status --db {url}")).contains("6 pending"));
    folder.ok(&format!("work --db {url} --threads 2"));
    folder.ok(&format!("run study.json --db {url} --out server"));
    let on_a_server = folder.ok(&format!("export study --db {url}"));
    assert_eq!(without_wall_times(&on_a_server), without_wall_times(&in_a_file));
    for figure in ["mu_star.svg", "regime_map.svg"] {
        assert_eq!(folder.read(format!("server/{figure}")), folder.read(format!("file/{figure}")));
    }

    folder.ok(&format!("copy --from {url} --to copied.db"));
    assert_eq!(folder.ok("export study --db copied.db"), on_a_server);
    folder.ok(&format!("report study --db {url} --out again"));
    folder.ok(&format!("rm study --db {url}"));
    assert!(folder.ok(&format!("gc --db {url}")).contains("dropped 6 jobs, 6 results"));
    folder.ok(&format!("copy study --from copied.db --to {url}"));
    assert_eq!(folder.ok(&format!("export study --db {url}")), on_a_server);

    let key = rows(&on_a_server)[0]["job"].clone();
    let show = format!("show {key}");
    for command in
        [&show, "status study", "status", "retry study --failed", "cancel study", "rm study", "gc", "status"]
    {
        let [there, here] = [url.as_str(), "copied.db"].map(|db| folder.ok(&format!("{command} --db {db}")));
        // The size in bytes depends on the kind of database.
        let without_size = |text: &str| text.split("; the database is").next().unwrap().to_owned();
        assert_eq!(without_size(&there), without_size(&here), "{command}");
    }
    // A server for tests may run without fsync, which doctor reports as a problem.
    let doctor = stdout(&folder.command(&format!("doctor --db {url}")).assert());
    assert_eq!(doctor.matches("PROBLEM").count(), doctor.matches("PROBLEM  fsync").count(), "{doctor}");
    assert!(doctor.contains("PostgreSQL") && doctor.contains("connections"), "{doctor}");
}

/// Protects: several workers share the jobs of a server. If one is killed, no job is lost, each job is stored once, and the
/// results are those of an uninterrupted run. The status lists the workers, their hosts and the jobs taken back.
#[test]
fn a_killed_worker_loses_nothing() {
    let Some(database) = ServerDatabase::new() else { return };
    let url = database.url();
    let (folder, in_a_file) = prepared(&long());
    folder.ok(&format!("submit study.json --db {url}"));
    let status =
        || -> Value { serde_json::from_str(&folder.ok(&format!("status study --json --db {url}"))).unwrap() };
    let work = format!("work --db {url} --threads 1 --lease 10s");
    let killed = folder.start(&work);
    wait("the first to have jobs", || status()["jobs"]["running"].as_u64() > Some(0));
    let at_work = status()["workers"][0].clone();
    let host = std::fs::read_to_string("/proc/sys/kernel/hostname").unwrap();
    assert_eq!((&at_work["host"], &at_work["presence"]), (&json!(host.trim()), &json!("working")));
    assert_eq!((&at_work["threads"], &at_work["process"]), (&json!(1), &json!(killed.id())));
    killed.signal("KILL");
    killed.end();
    let second = folder.start(&work);
    let third = folder.start(&work);
    assert_eq!((second.end().0, third.end().0), (Some(0), Some(0)));
    let lost = status()["workers"].as_array().unwrap().clone();
    assert_eq!(lost.len(), 1, "{lost:?}");
    assert_eq!((&lost[0]["presence"], &lost[0]["process"]), (&json!("lost"), &at_work["process"]));
    assert!(lost[0]["taken_back"].as_u64() > Some(0), "{lost:?}");
    assert!(folder.ok(&format!("status study --db {url}")).contains(" taken back from it"));
    let export = folder.ok(&format!("export study --db {url}"));
    assert_eq!(without_wall_times(&export), without_wall_times(&in_a_file));
    let results: i64 = block_on(async {
        let count = sqlx::query_scalar("SELECT COUNT(*) FROM results");
        count.fetch_one(&mut database.raw().await).await.unwrap()
    });
    assert_eq!(results.unsigned_abs(), LONG_JOBS);
}

/// A port that closes every connection until the address of the server behind it is set.
struct Relay {
    port: u16,
    refused: Arc<AtomicU32>,
    server: Arc<OnceLock<String>>,
}

impl Relay {
    fn new() -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let port = listener.local_addr().unwrap().port();
        let (refused, server) = (Arc::new(AtomicU32::new(0)), Arc::new(OnceLock::new()));
        let this = Self { port, refused: Arc::clone(&refused), server: Arc::clone(&server) };
        std::thread::spawn(move || {
            for client in listener.incoming() {
                let client = client.unwrap();
                let Some(server) = server.get() else {
                    refused.fetch_add(1, Ordering::Relaxed);
                    continue;
                };
                relay(&client, &TcpStream::connect(server).unwrap());
            }
        });
        this
    }

    fn refused(&self) -> u32 {
        self.refused.load(Ordering::Relaxed)
    }
}

fn relay(client: &TcpStream, server: &TcpStream) {
    for (from, to) in [(client, server), (server, client)] {
        let (mut from, mut to) = (from.try_clone().unwrap(), to.try_clone().unwrap());
        std::thread::spawn(move || {
            let _ = std::io::copy(&mut from, &mut to);
            let _ = to.shutdown(Shutdown::Both);
        });
    }
}

/// Protects: a worker with an idle exit that finds no server at its start waits for it, says why, runs the jobs when the
/// server answers, and can be stopped before. A worker without an idle exit ends immediately.
#[test]
fn a_worker_waits_for_its_server() {
    let Some(database) = ServerDatabase::new() else { return };
    let url = database.url();
    let folder = Folder::with("study", &small(&json!({ "mu": [0.2, 0.3] })));
    folder.ok(&format!("submit study.json --db {url}"));
    let relay = Relay::new();
    let (start, database_name) = url.rsplit_once('/').unwrap();
    let (user, address) = start.rsplit_once('@').unwrap();
    let relayed = format!("{user}@127.0.0.1:{}/{database_name}", relay.port);

    let message = stderr(&folder.command(&format!("work --db {relayed}")).assert().code(2));
    assert!(message.contains("no answer from the server"), "{message}");
    let work = format!("work --idle-exit 1s --db {relayed}");
    let stopped = folder.start(&work);
    let before = relay.refused();
    wait("a worker to try twice", || relay.refused() >= before + 2);
    stopped.signal("TERM");
    let (code, _, messages) = stopped.end();
    assert_eq!(code, Some(3), "{messages}");

    let patient = folder.start(&work);
    let before = relay.refused();
    wait("another worker to try twice", || relay.refused() >= before + 2);
    relay.server.set(address.to_owned()).unwrap();
    let (code, _, messages) = patient.end();
    assert_eq!(code, Some(0), "{messages}");
    assert!(messages.contains("waiting: ") && messages.contains("no answer from the server"), "{messages}");
    assert!(folder.ok(&format!("status study --db {url}")).contains("2 done"));
}

/// Protects: connections to a server that supports encryption are encrypted by default. If certificates are to be checked,
/// an untrusted one is refused immediately with advice, also by a worker that would wait for its server. The URL can name
/// a root certificate.
#[test]
fn connections_are_encrypted() {
    let Some(database) = ServerDatabase::new() else { return };
    let url = database.encrypted_url();
    let certificate: Option<String> = block_on(async {
        let certificate = "SELECT CASE current_setting('ssl') WHEN 'on'
                           THEN pg_read_file(current_setting('ssl_cert_file')) END";
        sqlx::query_scalar(certificate).fetch_one(&mut database.raw().await).await.unwrap()
    });
    let Some(certificate) = certificate else {
        tools::missing(
            "the server does not support encryption",
            "install openssl before `scripts/postgres.sh start FOLDER`",
        );
        return;
    };
    let folder = Folder::with("study", &small(&json!({ "mu": [0.2] })));
    folder.ok(&format!("submit study.json --db {url}"));
    let worker = folder.start(&format!("work --idle-exit 1h --db {url}"));
    let is_encrypted = || -> Option<bool> {
        let sessions = "SELECT bool_and(ssl) FROM pg_stat_ssl JOIN pg_stat_activity USING (pid)
                        WHERE datname = current_database() AND application_name = 'tribosweep'";
        block_on(async { sqlx::query_scalar(sessions).fetch_one(&mut database.raw().await).await.unwrap() })
    };
    wait("the worker to connect", || is_encrypted().is_some());
    assert_eq!(is_encrypted(), Some(true));
    worker.signal("INT");
    worker.end();

    // The certificate's issuer is checked, not the host name, which depends on the test server.
    let checked = format!("--db {url}?sslmode=verify-ca");
    for command in ["status", "work --idle-exit 1h"] {
        let message = stderr(&folder.command(&format!("{command} {checked}")).assert().code(2));
        assert!(
            message.contains("certificate is not trusted") && message.contains("sslrootcert"),
            "{message}"
        );
    }
    let trusted = format!("{checked}&sslrootcert={}", folder.path("site.crt").display());
    let message = stderr(&folder.command(&format!("work --idle-exit 1h {trusted}")).assert().code(2));
    assert!(message.contains("No such file") && message.contains("sslrootcert"), "{message}");
    std::fs::write(folder.path("site.crt"), certificate).unwrap();
    assert!(folder.ok(&format!("status study {trusted}")).contains("study"));
}

/// Protects: a server that does not answer, an empty database, a URL of another kind and an invalid URL have different
/// messages with advice, and no message contains a password.
#[cfg(feature = "postgres")]
#[test]
fn bad_urls_are_explained() {
    let folder = Folder::with("study", &small(&json!({ "mu": [0.3] })));
    let refusal = |arguments: &str| {
        let text = stderr(&folder.command(arguments).assert().code(2));
        assert!(!text.contains("secret"), "{text}");
        text
    };
    let nobody = refusal("submit study.json --db postgres://ada:secret@127.0.0.1:1/x");
    assert!(nobody.contains("postgres://ada@127.0.0.1:1/x") && nobody.contains("no answer"), "{nobody}");
    let other = refusal("status --db mysql://localhost/x");
    assert!(other.contains("mysql") && other.contains("postgres://"), "{other}");
    let port = refusal("status --db postgres://ada:secret@localhost:port/x");
    assert!(port.contains("postgres://USER@HOST"), "{port}");
    let Some(database) = ServerDatabase::new() else { return };
    let url = database.url();
    let empty = refusal(&format!("status --db {url}"));
    assert!(empty.contains("no database at") && empty.contains("tribosweep run"), "{empty}");
    let missing = refusal(&format!("submit study.json --db {}", url.replace('?', "_missing?")));
    assert!(missing.contains("does not exist"), "{missing}");
}
