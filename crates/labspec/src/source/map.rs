//! Piecewise maps from a derived text to the text from which it was made.

use std::ops::Range;

/// A range of derived text and the corresponding range of origin text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Piece {
    /// Bytes of the derived text.
    pub derived: Range<usize>,
    /// Bytes of the origin text.
    pub origin: Range<usize>,
    /// Whether both are equal byte for byte; otherwise they correspond only as a whole (an escape such as `\n`, a repaired
    /// quote).
    pub verbatim: bool,
}

impl Piece {
    /// Origin bytes of a range inside this piece.
    fn part(&self, range: Range<usize>) -> Range<usize> {
        if self.verbatim {
            let shift = |offset: usize| self.origin.start + offset.saturating_sub(self.derived.start);
            shift(range.start)..shift(range.end)
        } else {
            self.origin.clone()
        }
    }
}

/// A monotone map from byte ranges of a derived text to byte ranges of its origin.
///
/// Derived pieces follow each other without gaps from 0; origins may have gaps (removed text).
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SourceMap {
    pieces: Vec<Piece>,
}

impl SourceMap {
    /// The map of a text that equals `origin`, byte for byte.
    pub fn verbatim(origin: Range<usize>) -> SourceMap {
        let mut map = SourceMap::default();
        map.push_verbatim(origin);
        map
    }

    /// The map of a text of `length` bytes that corresponds to `origin` as a whole.
    pub fn whole(length: usize, origin: Range<usize>) -> SourceMap {
        let mut map = SourceMap::default();
        map.push_whole(length, origin);
        map
    }

    /// The map of an empty text with a position.
    pub fn point(offset: usize) -> SourceMap {
        SourceMap { pieces: vec![Piece { derived: 0..0, origin: offset..offset, verbatim: true }] }
    }

    /// Length of the derived text.
    pub fn derived_len(&self) -> usize {
        self.pieces.last().map_or(0, |p| p.derived.end)
    }

    /// The pieces, in order.
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// Appends derived bytes that equal these origin bytes. Adjacent pieces are joined.
    pub fn push_verbatim(&mut self, origin: Range<usize>) {
        if origin.is_empty() {
            return;
        }
        let start = self.derived_len();
        if let Some(last) = self.pieces.last_mut()
            && last.verbatim
            && last.origin.end == origin.start
        {
            last.derived.end += origin.len();
            last.origin.end = origin.end;
            return;
        }
        self.pieces.push(Piece { derived: start..start + origin.len(), origin, verbatim: true });
    }

    /// Appends `len` derived bytes that correspond to `origin` as a whole.
    pub fn push_whole(&mut self, len: usize, origin: Range<usize>) {
        let start = self.derived_len();
        if len > 0 {
            self.pieces.push(Piece { derived: start..start + len, origin, verbatim: false });
        }
    }

    /// The origin of a derived range: from the origin of its first byte to that of its last one. An empty range is a point.
    /// Ranges beyond the end are clipped.
    pub fn span(&self, range: Range<usize>) -> Range<usize> {
        let start = range.start.min(self.derived_len());
        let end = range.end.min(self.derived_len()).max(start);
        if start == end {
            let offset = self.origin_of(start);
            return offset..offset;
        }
        let first = self.piece_at(start).map_or(0, |p| p.part(start..start + 1).start);
        let last = self.piece_at(end - 1).map_or(first, |p| p.part(end - 1..end).end);
        first..last.max(first)
    }

    /// The origin of a position between two derived bytes: the start of the byte after it, or the end.
    fn origin_of(&self, offset: usize) -> usize {
        match self.piece_at(offset) {
            Some(piece) => piece.part(offset..offset).start,
            None => self.pieces.last().map_or(0, |p| p.origin.end),
        }
    }

    fn piece_at(&self, offset: usize) -> Option<&Piece> {
        let i = self.pieces.partition_point(|p| p.derived.end <= offset);
        self.pieces.get(i)
    }

    /// Whether a derived range corresponds byte for byte to one range of the origin, with nothing removed within it, nor
    /// after it where it ends a line.
    pub fn is_unbroken(&self, range: Range<usize>) -> bool {
        let first = self.pieces.partition_point(|p| p.derived.end <= range.start);
        let inside = self.pieces.iter().skip(first).take_while(|p| p.derived.start <= range.end);
        let joints = inside.collect::<Vec<_>>();
        let verbatim = joints.iter().all(|p| p.verbatim || p.derived.start >= range.end);
        let joined = joints.windows(2).all(|pair| match pair {
            [a, b] => a.origin.end == b.origin.start || (b.derived.start == range.end && range.is_empty()),
            _ => true,
        });
        verbatim && joined
    }

    /// The map of this map's derived text to the origin of `below`, where `below` maps this map's origin.
    pub fn then(&self, below: &SourceMap) -> SourceMap {
        let mut whole = SourceMap::default();
        for piece in &self.pieces {
            if piece.derived.is_empty() {
                let offset = below.origin_of(piece.origin.start);
                return SourceMap::point(offset);
            }
            if !piece.verbatim {
                whole.push_whole(piece.derived.len(), below.span(piece.origin.clone()));
                continue;
            }
            // A verbatim piece may cross several pieces below: split it at their boundaries.
            let mut offset = piece.origin.start;
            while offset < piece.origin.end {
                let Some(under) = below.piece_at(offset) else {
                    whole.push_whole(piece.origin.end - offset, below.span(offset..piece.origin.end));
                    break;
                };
                let end = under.derived.end.min(piece.origin.end);
                let origin = under.part(offset..end);
                if under.verbatim {
                    whole.push_verbatim(origin);
                } else {
                    whole.push_whole(end - offset, origin);
                }
                offset = end;
            }
        }
        whole
    }

    /// The map with all origin ranges shifted by `offset`: its origin text is a slice of a larger one that starts there.
    pub fn shifted(mut self, offset: usize) -> SourceMap {
        for piece in &mut self.pieces {
            piece.origin = piece.origin.start + offset..piece.origin.end + offset;
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn escapes_map_as_a_whole() {
        // a\nb in a file at 10: "a" 10..11, "\n" 11..13, "b" 13..14
        let mut map = SourceMap::default();
        map.push_verbatim(10..11);
        map.push_whole(1, 11..13);
        map.push_verbatim(13..14);
        assert_eq!(map.span(0..3), 10..14);
        assert_eq!(map.span(1..2), 11..13);
        assert_eq!(map.span(2..3), 13..14);
        assert_eq!(map.span(3..3), 14..14);
        assert_eq!(map.span(1..1), 11..11);
        assert_eq!(map.span(2..90), 13..14);
    }

    #[test]
    fn verbatim_neighbours_become_one_piece() {
        let mut map = SourceMap::default();
        map.push_verbatim(5..7);
        map.push_verbatim(7..10);
        assert_eq!(map.pieces().len(), 1);
    }

    /// A map with pieces of the given (derived length, gap before, origin length) and its derived length.
    fn build(parts: &[(usize, usize, usize)]) -> SourceMap {
        let (mut map, mut offset) = (SourceMap::default(), 0);
        for &(len, gap, origin) in parts {
            let stretch = offset + gap..offset + gap + origin;
            if len == origin {
                map.push_verbatim(stretch)
            } else {
                map.push_whole(len, stretch)
            }
            offset += gap + origin;
        }
        map
    }

    proptest! {
        /// Spans keep their order, and a larger range never maps to a smaller one.
        #[test]
        fn maps_are_monotone(parts in prop::collection::vec((1usize..6, 0usize..4, 1usize..6), 1..12), a in 0usize..40, b in 0usize..40) {
            let map = build(&parts);
            let (a, b) = (a.min(b), a.max(b));
            let (outer, left) = (map.span(a..b), map.span(a..a));
            prop_assert!(left.start <= outer.start && outer.start <= outer.end);
            for i in a..b.min(map.derived_len()) {
                let one = map.span(i..i + 1);
                prop_assert!(outer.start <= one.start && one.end <= outer.end);
            }
        }

        /// Composing maps equals mapping twice, byte by byte.
        #[test]
        fn composition_maps_twice(
            top in prop::collection::vec((1usize..6, 0usize..4, 1usize..6), 1..8),
            low in prop::collection::vec((1usize..6, 0usize..4, 1usize..6), 1..12),
        ) {
            let (top, low) = (build(&top), build(&low));
            let both = top.then(&low);
            prop_assert_eq!(both.derived_len(), top.derived_len());
            for i in 0..top.derived_len() {
                prop_assert_eq!(both.span(i..i + 1), low.span(top.span(i..i + 1)));
            }
        }
    }
}
