//! The Pareto front of points with a cost and an error.

/// For each point (cost, error) whether it is on the front: no other point has at most the same cost and at most the same
/// error, and less of one of them. Points with a number that is not finite are never on it.
pub fn on_front(points: &[(f64, f64)]) -> Vec<bool> {
    let mut order: Vec<usize> =
        (0..points.len()).filter(|&i| points[i].0.is_finite() && points[i].1.is_finite()).collect();
    order.sort_by(|&a, &b| points[a].0.total_cmp(&points[b].0).then(points[a].1.total_cmp(&points[b].1)));
    let mut front = vec![false; points.len()];
    let mut least_error = f64::INFINITY;
    for same_cost in order.chunk_by(|&a, &b| points[a].0 == points[b].0) {
        let here = points[same_cost[0]].1;
        if here < least_error {
            for &i in same_cost.iter().take_while(|&&i| points[i].1 == here) {
                front[i] = true;
            }
            least_error = here;
        }
    }
    front
}
