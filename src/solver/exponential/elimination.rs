//! Linear equations between couplings, three unknowns each, solved by elimination.
//!
//! ```text
//!   F_p + sum over q of A_pq F_q = r_p
//!   forwards, p in order    A_qr -= A_qp A_pp^-1 A_pr,  r_q -= A_qp A_pp^-1 r_p       q, r: neighbours of p that are left
//!   backwards               F_p = A_pp^-1 (r_p - sum over q of A_pq F_q)
//! ```
//!
//! Which couplings have to do with each other never changes, so the order and the places of all blocks are found once. The next
//! one is always one that joins the fewest others anew: where shafts and gears form a tree nothing fills up, and the work grows with
//! the number of couplings.

use std::collections::{BTreeMap, BTreeSet};

use super::exchange::Pair;
use super::lanes::{Quad, add_multiple, subtract_multiple};
use super::polynomials::NODES;

/// Unknowns of a coupling: its forces at all nodes but the first.
const UNKNOWN: usize = NODES - 1;

/// What the unknowns of one coupling do to another: a column for each. The first number of every column is zero, as is that
/// of the unknowns: it stands for the start of the step, where nothing is unknown.
pub(super) type Square = [Quad; UNKNOWN];

/// The order of elimination.
#[derive(Debug, Clone)]
pub(super) struct Elimination {
    pivots: Vec<Pivot>,
    /// Number of blocks.
    blocks: usize,
}

/// A coupling at its turn.
#[derive(Debug, Clone)]
struct Pivot {
    coupling: usize,
    /// Where its block on the diagonal is.
    own: usize,
    neighbours: Vec<Neighbour>,
}

/// A neighbour that is left then.
#[derive(Debug, Clone)]
struct Neighbour {
    coupling: usize,
    /// Where the blocks are that say what it does to the pivot, and the pivot to it.
    to_pivot: usize,
    from_pivot: usize,
    /// Where its own row has the blocks of all neighbours.
    row: Vec<usize>,
}

impl Elimination {
    /// For blocks in these places, in the order of the pairs; more of them may follow.
    pub(super) fn of(pairs: &[Pair], couplings: usize) -> Elimination {
        let mut places: BTreeMap<Pair, usize> = pairs.iter().copied().zip(0..).collect();
        let mut place = |sensor: usize, actuator: usize| {
            let next = places.len();
            *places.entry(Pair { sensor, actuator }).or_insert(next)
        };
        let mut graph = vec![BTreeSet::new(); couplings];
        for pair in pairs.iter().filter(|pair| pair.sensor != pair.actuator) {
            graph[pair.sensor].insert(pair.actuator);
            graph[pair.actuator].insert(pair.sensor);
        }
        let mut left: BTreeSet<usize> = (0..couplings).collect();
        let mut pivots = Vec::with_capacity(couplings);
        while let Some(coupling) = next_of(&left, &graph) {
            left.remove(&coupling);
            let neighbours = core::mem::take(&mut graph[coupling]);
            for &one in &neighbours {
                graph[one].remove(&coupling);
                let others = neighbours.iter().filter(|&&other| other != one);
                graph[one].extend(others);
            }
            let neighbour = |&one: &usize| Neighbour {
                coupling: one,
                to_pivot: place(coupling, one),
                from_pivot: place(one, coupling),
                row: neighbours.iter().map(|&other| place(one, other)).collect(),
            };
            let neighbours = neighbours.iter().map(neighbour).collect();
            pivots.push(Pivot {
                coupling,
                own: place(coupling, coupling),
                neighbours,
            });
        }
        Elimination {
            pivots,
            blocks: places.len(),
        }
    }

    /// Number of couplings.
    pub(super) fn couplings(&self) -> usize {
        self.pivots.len()
    }

    /// Number of blocks: those of the pairs, then those that fill up, to be set to zero before.
    pub(super) fn blocks(&self) -> usize {
        self.blocks
    }

    /// Overwrites the blocks with what [`Self::substitute`] needs.
    #[inline(always)]
    pub(super) fn factorize(&self, blocks: &mut [Square]) {
        for pivot in &self.pivots {
            let inverse = inverse_with_one(&blocks[pivot.own]);
            blocks[pivot.own] = inverse;
            for neighbour in &pivot.neighbours {
                let factor = times(&blocks[neighbour.from_pivot], &inverse);
                blocks[neighbour.from_pivot] = factor;
                for (other, &place) in pivot.neighbours.iter().zip(&neighbour.row) {
                    let to_pivot = blocks[other.to_pivot];
                    subtract_times(&mut blocks[place], &factor, &to_pivot);
                }
            }
        }
    }

    /// Overwrites the right-hand sides with the unknowns. What stands first in every side stays, even where unknowns are no numbers.
    #[inline(always)]
    pub(super) fn substitute(&self, blocks: &[Square], sides: &mut [Quad]) {
        for pivot in &self.pivots {
            let side = sides[pivot.coupling];
            for neighbour in &pivot.neighbours {
                let factor = &blocks[neighbour.from_pivot];
                subtract_product(&mut sides[neighbour.coupling], factor, &side);
            }
        }
        for pivot in self.pivots.iter().rev() {
            let mut side = sides[pivot.coupling];
            for neighbour in &pivot.neighbours {
                let unknowns = &sides[neighbour.coupling];
                subtract_product(&mut side, &blocks[neighbour.to_pivot], unknowns);
            }
            sides[pivot.coupling] = solved(&blocks[pivot.own], &side);
        }
    }
}

/// The coupling whose elimination joins the fewest others that have nothing to do with each other yet; the first of these.
fn next_of(left: &BTreeSet<usize>, graph: &[BTreeSet<usize>]) -> Option<usize> {
    let joined_anew = |coupling: usize| {
        let neighbours = &graph[coupling];
        let strangers = |one: &usize| neighbours.difference(&graph[*one]).count() - 1;
        neighbours.iter().map(strangers).sum::<usize>()
    };
    let mut best = None;
    for &coupling in left {
        let count = joined_anew(coupling);
        if count == 0 {
            return Some(coupling);
        }
        if best.is_none_or(|(least, _)| count < least) {
            best = Some((count, coupling));
        }
    }
    best.map(|(_, coupling)| coupling)
}

/// The unknowns of a coupling by itself, from the inverse of its block. What stands first in the side stays.
#[inline(always)]
pub(super) fn solved(inverse: &Square, side: &Quad) -> Quad {
    let mut unknowns = [0.0; 4];
    add_product(&mut unknowns, inverse, side);
    unknowns[0] = side[0];
    unknowns
}

/// The product of two matrices.
#[inline(always)]
pub(super) fn times(one: &Square, two: &Square) -> Square {
    let mut product = Square::default();
    for (product, column) in product.iter_mut().zip(two) {
        add_product(product, one, column);
    }
    product
}

/// target -= the product of two matrices.
#[inline(always)]
pub(super) fn subtract_times(target: &mut Square, one: &Square, two: &Square) {
    for (target, column) in target.iter_mut().zip(two) {
        subtract_product(target, one, column);
    }
}

/// sum += matrix times unknowns.
#[inline(always)]
fn add_product(sum: &mut Quad, columns: &Square, [_, x @ ..]: &Quad) {
    for (column, x) in columns.iter().zip(x) {
        add_multiple(sum, *x, column);
    }
}

/// side -= matrix times unknowns. What stands first in the side stays.
#[inline(always)]
pub(super) fn subtract_product(side: &mut Quad, columns: &Square, [_, x @ ..]: &Quad) {
    let first = side[0];
    for (column, x) in columns.iter().zip(x) {
        subtract_multiple(side, *x, column);
    }
    side[0] = first; // zero times what is no number is none either
}

/// (1 + A)^-1, by cofactors.
#[inline(always)]
pub(super) fn inverse_with_one([a, b, c]: &Square) -> Square {
    let a = [0.0, a[1] + 1.0, a[2], a[3]];
    let b = [0.0, b[1], b[2] + 1.0, b[3]];
    let c = [0.0, c[1], c[2], c[3] + 1.0];
    let rows = [cross(&b, &c), cross(&c, &a), cross(&a, &b)];
    let determinant = a[1] * rows[0][1] + a[2] * rows[0][2] + a[3] * rows[0][3];
    let scale = 1.0 / determinant;
    let mut inverse = Square::default();
    for (i, row) in rows.iter().enumerate() {
        for (column, entry) in inverse.iter_mut().zip(&row[1..]) {
            column[i + 1] = scale * entry;
        }
    }
    inverse
}

/// The cross product of the last three numbers of both.
#[inline(always)]
fn cross(x: &Quad, y: &Quad) -> Quad {
    [
        0.0,
        x[2] * y[3] - x[3] * y[2],
        x[3] * y[1] - x[1] * y[3],
        x[1] * y[2] - x[2] * y[1],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The pairs of couplings that have to do with each other, each with itself included.
    fn pairs(couplings: usize, joined: &[[usize; 2]]) -> Vec<Pair> {
        let own = (0..couplings).map(|one| [one, one]);
        let both = joined.iter().flat_map(|&[a, b]| [[a, b], [b, a]]);
        let mut pairs: Vec<Pair> = own
            .chain(both)
            .map(|[sensor, actuator]| Pair { sensor, actuator })
            .collect();
        pairs.sort_unstable();
        pairs
    }

    #[test]
    fn nothing_fills_up_where_gears_form_a_tree() {
        // Meshes 0 to 3 on one shaft; behind two of them other shafts with a further mesh each.
        let shaft = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];
        let pairs = pairs(6, &[&shaft[..], &[[2, 4], [3, 5]]].concat());
        assert_eq!(Elimination::of(&pairs, 6).blocks(), pairs.len());
    }

    #[test]
    fn what_stands_first_stays_where_unknowns_are_no_numbers() {
        let plan = Elimination::of(&pairs(2, &[[0, 1]]), 2);
        let mut blocks = vec![[[0.0, f64::NAN, 1.0, 1.0]; 3]; plan.blocks()];
        let mut sides = vec![[3.0, 1.0, 1.0, 1.0]; 2];
        plan.factorize(&mut blocks);
        plan.substitute(&blocks, &mut sides);
        for side in sides {
            assert!(side[0] == 3.0 && side[1].is_nan(), "{side:?}");
        }
    }

    #[test]
    fn unknowns_solve_the_equations() {
        // A ring, where blocks fill up, and a coupling alone.
        let pairs = pairs(6, &[[0, 1], [1, 2], [2, 3], [3, 4], [4, 0]]);
        let plan = Elimination::of(&pairs, 6);
        assert!(plan.blocks() > pairs.len());
        let entry = |number: usize, column: usize, row: usize| {
            let odd = (7 * number + 5 * column + 3 * row) % 11;
            0.08 * (odd as f64 - 5.0)
        };
        let mut blocks = vec![Square::default(); plan.blocks()];
        for (number, block) in blocks[..pairs.len()].iter_mut().enumerate() {
            *block = core::array::from_fn(|j| {
                core::array::from_fn(|i| if i == 0 { 0.0 } else { entry(number, j, i) })
            });
        }
        let matrix = blocks.clone();
        let sides: Vec<Quad> = (0..6)
            .map(|one| [9.0, 1.0, one as f64, -0.5 * one as f64])
            .collect();
        let mut unknowns = sides.clone();
        plan.factorize(&mut blocks);
        plan.substitute(&blocks, &mut unknowns);
        let mut rest = sides;
        for (rest, unknowns) in rest.iter_mut().zip(&unknowns) {
            for (rest, unknown) in rest[1..].iter_mut().zip(&unknowns[1..]) {
                *rest -= unknown;
            }
        }
        for (pair, block) in pairs.iter().zip(&matrix) {
            subtract_product(&mut rest[pair.sensor], block, &unknowns[pair.actuator]);
        }
        for (rest, unknowns) in rest.iter().zip(&unknowns) {
            assert_eq!([rest[0], unknowns[0]], [9.0; 2]);
            for rest in &rest[1..] {
                // 1e-13: rounding of some dozen operations between numbers up to 10.
                assert!(rest.abs() < 1e-13, "{rest}");
            }
        }
    }
}
