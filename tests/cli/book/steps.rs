//! What a reader does with a page: its blocks in their order.

/// What a reader does with a block.
#[derive(Debug, PartialEq)]
pub enum Step<'a> {
    /// Saves a text as a file.
    Save(&'a str, &'a str),
    /// Tries a study, or a part of one.
    Check(&'a str),
    /// Runs commands.
    Run(&'a str),
    /// Runs a program in Python.
    Python(&'a str),
    /// Compares the output of the last commands with the page.
    Compare(&'a str),
}

/// A block of a page.
pub struct Block<'a> {
    /// The text between the block before and this one.
    pub before: &'a str,
    pub language: &'a str,
    pub body: &'a str,
}

/// The blocks of a page.
pub fn blocks(page: &str) -> impl Iterator<Item = Block<'_>> {
    let mut parts = page.split("```");
    std::iter::from_fn(move || {
        let (before, block) = (parts.next()?, parts.next()?);
        let (language, body) = block.split_once('\n').expect("a block begins with its language");
        Some(Block { before, language, body })
    })
}

/// The steps of a page. A block after a line "Save this as `NAME`" is a file. A `text` right after `sh` is its output. Other
/// `text`, and `console`, is not for this machine.
pub fn steps(page: &str) -> Vec<Step<'_>> {
    let mut steps = Vec::new();
    let mut ran = false;
    for Block { before, language, body } in blocks(page) {
        let saved = before.rsplit_once("Save this as `").and_then(|(_, rest)| rest.split_once('`'));
        match (language, saved) {
            ("json" | "csv", Some((name, _))) => steps.push(Step::Save(name, body)),
            ("json", None) => steps.push(Step::Check(body)),
            ("sh", _) => steps.push(Step::Run(body)),
            ("python", _) => steps.push(Step::Python(body)),
            ("text", _) if ran => steps.push(Step::Compare(body)),
            ("text" | "console", _) => {}
            _ => panic!("a reader does not know what to do with a block of {language:?}:\n{body}"),
        }
        ran = language == "sh";
    }
    steps
}

/// A whole study around a part of one: `"holder": {…}` belongs to the scene.
pub fn whole_study(part: &str) -> String {
    if part.trim_start().starts_with('{') {
        return part.to_owned();
    }
    let field = part.trim_start().trim_start_matches('"').split('"').next().unwrap();
    match field {
        "clamp" | "contact" | "disk" | "holder" => format!("{{ \"scene\": {{ {part} }} }}"),
        "base" => format!("{{ \"scene\": {{ \"pin\": {{ {part} }} }} }}"),
        _ => format!("{{ {part} }}"),
    }
}

/// Protects: the tests of the pages see what the pages have.
#[test]
fn steps_are_found() {
    let page = "Save this as `a.json`, and\nmore:\n\n```json\n{}\n```\n```sh\nrun\n```\nIt prints:\n\n```text\nx\n```\n```text\ny\n```\n```json\n1\n```\n```console\nc\n```\n```python\np\n```\n";
    let expected = [
        Step::Save("a.json", "{}\n"),
        Step::Run("run\n"),
        Step::Compare("x\n"),
        Step::Check("1\n"),
        Step::Python("p\n"),
    ];
    assert_eq!(steps(page), expected);
    assert_eq!(whole_study("{ }"), "{ }");
    assert_eq!(whole_study("\"grid\": 1"), "{ \"grid\": 1 }");
    assert_eq!(whole_study("\"disk\": 1"), "{ \"scene\": { \"disk\": 1 } }");
    assert_eq!(whole_study("\"base\": 1"), "{ \"scene\": { \"pin\": { \"base\": 1 } } }");
}
