use std::io::{self, Write};

use super::vtu::{Appended, Ids, VTK_TYPES, bytes};
use walpha_check::Finding;

/// Writes the simplices and points of findings as VTU, once for each finding, over all points. Cell data are `finding`, its
/// number in the list from 0, and `rule`; the field `rule_legend` names the rules.
///
/// # Errors
/// Errors of the writer.
///
/// # Panics
/// Never: the rule of each finding is listed.
pub fn write_findings(
    findings: &[Finding],
    positions: &[[f64; 3]],
    out: &mut dyn Write,
) -> io::Result<()> {
    let mut rules: Vec<&str> = findings.iter().map(Finding::rule).collect();
    rules.sort_unstable();
    rules.dedup();
    let exist = |part: &&[u32]| part.iter().all(|&v| (v as usize) < positions.len());
    let parts = findings.iter().enumerate().flat_map(|(number, finding)| {
        let rule = rules.binary_search(&finding.rule()).expect("all rules are listed") as u8;
        let parts = finding.parts().into_iter().filter(exist);
        parts.map(move |part| (part, number as u32, rule))
    });
    let parts: Vec<(&[u32], u32, u8)> = parts.collect();
    let corners = parts.iter().map(|(part, ..)| part.len()).sum::<usize>();
    let mut connectivity = Ids::up_to(corners.max(positions.len()));
    let mut offsets = Ids::up_to(corners);
    let mut end = 0;
    for (part, ..) in &parts {
        part.iter().for_each(|&v| connectivity.push(v as usize));
        end += part.len();
        offsets.push(end);
    }
    let mut file = Appended::default();
    file.begin("")?;
    let legend: Vec<String> =
        rules.iter().enumerate().map(|(number, rule)| format!("{number} {rule}")).collect();
    writeln!(file.xml, "<FieldData>")?;
    file.text("rule_legend", &legend.join(", "), false)?;
    write!(
        file.xml,
        "</FieldData>\n<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<CellData>\n",
        positions.len(),
        parts.len(),
    )?;
    file.array("UInt32", "finding", 1, bytes(parts.iter().map(|part| part.1.to_le_bytes())))?;
    file.array("UInt8", "rule", 1, parts.iter().map(|part| part.2).collect())?;
    writeln!(file.xml, "</CellData>")?;
    let types = parts.iter().map(|(part, ..)| VTK_TYPES[part.len() - 1]).collect();
    file.grid(positions.iter().copied(), connectivity, offsets, types)?;
    file.end(out)
}
