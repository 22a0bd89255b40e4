use anyhow::bail;
use walpha::ladder::Region;

/// Parses X0:X1,Y0:Y1,Z0:Z1.
pub fn region(text: &str) -> anyhow::Result<Region> {
    let ranges: Vec<&str> = text.split(',').collect();
    let mut region = Region { low: [0.0; 3], high: [0.0; 3] };
    if ranges.len() != 3 {
        bail!("three ranges are needed, as in 20:40,20:40,10:30 for x, y and z");
    }
    for (k, range) in ranges.iter().enumerate() {
        let Some((low, high)) = range.split_once(':') else {
            bail!("`{range}` is no range: two numbers are needed, as in 20:40");
        };
        (region.low[k], region.high[k]) = (low.trim().parse()?, high.trim().parse()?);
        let finite = region.low[k].is_finite() && region.high[k].is_finite();
        if !finite || region.low[k] > region.high[k] {
            bail!("`{range}` is no range: the first number must not be larger, and both finite");
        }
    }
    Ok(region)
}
