//! Draws the chart of two falling balls (`fall` in crates/plot/src/tests.rs) with plotters.

use plotters::prelude::*;
fn main() {
    let root = SVGBackend::new("fall.svg", (640, 300)).into_drawing_area();
    root.fill(&WHITE).unwrap();
    let mut c = ChartBuilder::on(&root)
        .caption("Two balls fall from 1 m", ("sans-serif", 16))
        .margin(8)
        .x_label_area_size(32)
        .y_label_area_size(48)
        .build_cartesian_2d(0f64..1.5, 0f64..1.0)
        .unwrap();
    c.configure_mesh().x_desc("time (s)").y_desc("height of the centre (m)").draw().unwrap();
    let t: Vec<f64> = (0..=750).map(|i| f64::from(i) * 0.002).collect();
    let s: [(&str, Box<dyn Fn(f64) -> f64>, RGBColor); 3] = [
        ("heavy ball", Box::new(|t| (1.0f64 - 0.5 * 9.81 * t * (t + 0.002)).max(0.05)), BLUE),
        ("light ball with drag", Box::new(|t| (1.0f64 - 0.35 * 9.81 * t * t).max(0.05)), RED),
        ("1 - g t^2/2", Box::new(|t| (1.0f64 - 0.5 * 9.81 * t * t).max(0.05)), BLACK),
    ];
    for (name, f, col) in &s {
        let col = *col;
        c.draw_series(LineSeries::new(t.iter().map(|t| (*t, f(*t))), &col))
            .unwrap()
            .label(*name)
            .legend(move |(x, y)| PathElement::new(vec![(x, y), (x + 18, y)], col));
    }
    c.configure_series_labels().border_style(BLACK).draw().unwrap();
    root.present().unwrap();
}
