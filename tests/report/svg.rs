//! A reader of the SVG that figures are made of; panics where the XML is not well-formed.

/// An element: its name, its attributes and its own text.
#[derive(Debug, Clone, PartialEq)]
pub struct Element {
    pub name: String,
    pub attributes: Vec<(String, String)>,
    pub text: String,
}

impl Element {
    pub fn attribute(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find(|(own, _)| own == name).map(|(_, value)| value.as_str())
    }

    pub fn is(&self, name: &str, value: &str) -> bool {
        self.attribute(name) == Some(value)
    }
}

/// Parses a document without comments, declarations and CDATA into its elements, in document order.
pub fn parse(document: &str) -> Vec<Element> {
    let allowed = |c: char| !c.is_control() || matches!(c, '\n' | '\r' | '\t');
    assert!(document.chars().all(allowed), "a control character");
    let mut elements: Vec<Element> = Vec::new();
    let mut open: Vec<usize> = Vec::new();
    let mut rest = document.trim();
    while let Some(start) = rest.find('<') {
        let text = unescape(rest[..start].trim());
        match open.last() {
            Some(&index) => elements[index].text += &text,
            None => assert_eq!(text, "", "text outside of the root"),
        }
        let end = start + rest[start..].find('>').expect("a tag ends");
        let tag = &rest[start + 1..end];
        rest = &rest[end + 1..];
        if let Some(name) = tag.strip_prefix('/') {
            let index = open.pop().expect("an element is open");
            assert_eq!(elements[index].name, name, "elements overlap");
            continue;
        }
        let (tag, closed) = tag.strip_suffix('/').map_or((tag, false), |tag| (tag, true));
        assert!(elements.is_empty() || !open.is_empty(), "two roots");
        elements.push(element(tag));
        if !closed {
            open.push(elements.len() - 1);
        }
    }
    assert!(open.is_empty(), "an element is not closed");
    assert_eq!(rest, "", "text behind the root");
    elements
}

fn element(tag: &str) -> Element {
    let (name, mut rest) = tag.split_once(' ').unwrap_or((tag, ""));
    assert!(!name.is_empty() && name.chars().all(char::is_alphanumeric), "element name {name:?}");
    let mut attributes: Vec<(String, String)> = Vec::new();
    while !rest.trim().is_empty() {
        let (key, after) = rest.trim_start().split_once("=\"").expect("an attribute is key=\"value\"");
        let (value, after) = after.split_once('"').expect("an attribute's value ends");
        assert!(!value.contains('<'), "`<` in an attribute");
        assert!(attributes.iter().all(|(own, _)| own != key), "attribute {key} twice");
        attributes.push((key.to_owned(), unescape(value)));
        rest = after;
    }
    Element { name: name.to_owned(), attributes, text: String::new() }
}

fn unescape(text: &str) -> String {
    let mut parts = text.split('&');
    let mut plain = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (entity, after) = part.split_once(';').expect("`&` begins an entity");
        plain.push(match entity {
            "lt" => '<',
            "gt" => '>',
            "amp" => '&',
            "quot" => '"',
            "apos" => '\'',
            other => panic!("unknown entity {other}"),
        });
        plain += after;
    }
    plain
}
