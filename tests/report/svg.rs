//! Reads the SVG of figures; panics where the XML is not well-formed.

use roxmltree::{Document, Node};

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

/// The elements of a document, in document order.
pub fn parse(document: &str) -> Vec<Element> {
    // XML does not allow control characters.
    let allowed = |c: char| !c.is_control() || matches!(c, '\n' | '\r' | '\t');
    assert!(document.chars().all(allowed), "a control character");
    let document = Document::parse(document).expect("well-formed XML");
    document.descendants().filter(Node::is_element).map(element).collect()
}

fn element(node: Node) -> Element {
    let attributes =
        node.attributes().map(|attribute| (attribute.name().to_owned(), attribute.value().to_owned()));
    let texts = node.children().filter(Node::is_text).filter_map(|child| child.text());
    Element {
        name: node.tag_name().name().to_owned(),
        attributes: attributes.collect(),
        text: texts.map(str::trim).collect(),
    }
}
