//! Protects: a study's height map is read once, with the study, and jobs contain its heights.

use tempfile::TempDir;
use tribosweep::study::Study;

const MAP: &str = "0 1e-6 2e-6\n1e-6 0 0\n0 0 -1e-6\n";

fn folder(name: &str, map: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(name), map).unwrap();
    folder
}

fn study(folder: &TempDir, map: &str) -> Result<Study, tribosweep::study::StudyError> {
    let path = folder.path().join("rough.json");
    let text = format!(
        "{{ // rough\n  \"scene\": {{ \"pin\": {{ \"base\": {{ \"height_map\": {{\n {map}\n }} }} }} }},\n  \"grid\": {{ \"mu\": [0.3, 0.4] }} }}"
    );
    std::fs::write(&path, text).unwrap();
    Study::load(&path)
}

fn keys(study: &Study) -> Vec<String> {
    study.expand("1").unwrap().into_iter().map(|job| job.key).collect()
}

/// Protects: the database's study and jobs do not need the file, and a key depends on the heights and not on the file's name.
#[test]
fn jobs_contain_the_heights() {
    let first = folder("map.csv", MAP);
    let found = study(&first, r#""file": "map.csv", "spacing_m": 0.01"#).unwrap();
    let map = found.base().scene.pin.base.height_map.as_ref().unwrap();
    assert_eq!(map.heights_m, [[0.0, 1e-6, 2e-6], [1e-6, 0.0, 0.0], [0.0, 0.0, -1e-6]]);
    assert_eq!(map.file, None);
    let document = found.document();
    assert!(document.contains("// rough") && !document.contains("map.csv"), "{document}");
    std::fs::remove_file(first.path().join("map.csv")).unwrap();
    let stored = Study::parse_stored(&document, "rough", None).unwrap();
    assert_eq!(keys(&stored), keys(&found));

    let renamed = folder("other.txt", &MAP.replace(' ', ";"));
    let same = study(&renamed, r#""file": "other.txt", "spacing_m": 0.01"#).unwrap();
    assert_eq!(keys(&same), keys(&found));
    let changed = folder("map.csv", &MAP.replace("2e-6", "3e-6"));
    let other = study(&changed, r#""file": "map.csv", "spacing_m": 0.01"#).unwrap();
    assert!(keys(&other).iter().zip(keys(&found)).all(|(a, b)| *a != b));
    // Equal heights are a plane.
    let plane = folder("map.csv", "1e-6,1e-6\n1e-6,1e-6");
    let plane = study(&plane, r#""file": "map.csv", "spacing_m": 0.02"#).unwrap();
    let text = r#"{ "name": "rough", "grid": { "mu": [0.3, 0.4] } }"#;
    assert_eq!(keys(&plane), keys(&Study::parse(text, "rough.json").unwrap()));
}

/// Protects: what is wrong with a map is said with the file and the line, and fields behind it keep their lines.
#[test]
fn a_bad_map_is_named() {
    for (map, fields, expected) in [
        ("1 2\n3 NaN", r#""file": "map.csv", "spacing_m": 0.01"#, "map.csv:2: `NaN` at place 2"),
        ("1 2\n3", r#""file": "map.csv", "spacing_m": 0.01"#, "map.csv:2: 1 heights: expected 2"),
        (MAP, r#""file": "map.csv", "spacing_m": 0.007"#, "expected at least 0.0075 m"),
        (MAP, r#""file": "none.csv", "spacing_m": 0.01"#, "none.csv: cannot be read"),
        (MAP, r#""file": "map.csv", "heights_m": [[0, 0], [0, 0]], "spacing_m": 0.01"#, "either a file or"),
        (MAP, r#""spacing_m": 0.01"#, "0 rows of 0"),
        (MAP, r#""heights_m": [[0, 0], [0, 0, 0]], "spacing_m": 0.1"#, "3 heights in row 2: expected 2"),
        (MAP, r#""file": "map.csv""#, "spacing_m = 0: expected a distance > 0 m"),
    ] {
        let folder = folder("map.csv", map);
        let message = study(&folder, fields).unwrap_err().to_string();
        assert!(message.contains(expected), "{fields}: {message}");
    }
    let good = folder("map.csv", MAP);
    let text = "{ \"scene\": { \"pin\": { \"base\": { \"height_map\": {\n\"file\": \"map.csv\",\n\"spacing_m\": 0.01 } } } },\n \"grid\": { \"mu\": [-1] } }";
    let path = good.path().join("rough.json");
    std::fs::write(&path, text).unwrap();
    let error = Study::load(&path).unwrap_err();
    assert_eq!(error.problems()[0].position.unwrap().line, 4, "{error}");
    // A document of a database that names a file was not made by this program.
    let error = Study::parse_stored(text, "rough", None).unwrap_err().to_string();
    assert!(error.contains("height_map.file"), "{error}");
}
