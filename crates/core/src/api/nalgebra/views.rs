//! Fields of the data as vectors and matrices that share their memory with the data.

use crate::api::data::{Data, Scope};
use crate::api::error::Error;
use crate::model::reflect::{self, FieldId, Object, View};
use nalgebra::{Const, DMatrixView, DVectorView, Dyn, U1};

/// A field as a matrix with one row per object. The engine stores rows one after the other.
pub type RowsView<'a> = DMatrixView<'a, f64, Dyn, U1>;

/// The number of elements in each row of a field. A list of numbers has one.
fn width(field: FieldId) -> Option<usize> {
    field
        .info()
        .shape
        .iter()
        .skip(1)
        .try_fold(1, |product: usize, dim| Some(product * dim.parse::<usize>().ok()?))
}

impl<S: Scope> Data<S> {
    /// The numbers of a field of the data as a vector, without a copy: `qpos`, `qvel`, `qacc`, `sensordata`, …
    ///
    /// The units are those of the field. To write a vector, use `data.edit().qvel.copy_from_slice(v.as_slice())`.
    ///
    /// # Errors
    ///
    /// There is no such field, it does not hold floating-point numbers, or the plan left it out.
    pub fn field_vector(&self, name: &str) -> Result<DVectorView<'_, f64>, Error> {
        let (_, numbers) = self.floats(name)?;
        Ok(DVectorView::from_slice(numbers, numbers.len()))
    }

    /// The numbers of a field of the data as a matrix with one row per object, without a copy: `xpos` is nbody × 3, `xmat`
    /// nbody × 9 (each row a rotation matrix by rows), `cvel` nbody × 6 (angular, then linear).
    ///
    /// # Errors
    ///
    /// As for [`Data::field_vector`].
    pub fn field_matrix(&self, name: &str) -> Result<RowsView<'_>, Error> {
        let (field, numbers) = self.floats(name)?;
        let width = width(field).unwrap_or(1).max(1);
        let shape = (Dyn(numbers.len() / width), Dyn(width));
        Ok(RowsView::from_slice_with_strides_generic(numbers, shape.0, shape.1, Dyn(width), Const::<1>))
    }

    fn floats(&self, name: &str) -> Result<(FieldId, &[f64]), Error> {
        let field = reflect::field(Object::Data, name).ok_or_else(|| Error::NoField(name.into()))?;
        match self.read(field)? {
            View::F64(numbers) => Ok((field, numbers)),
            _ => Err(Error::Value { what: field.info().name, must: "a field of floating-point numbers" }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::width;
    use crate::model::reflect::{self, Object};

    #[test]
    fn every_field_of_the_data_has_rows_of_a_fixed_width() {
        let data = reflect::fields().filter(|f| f.info().object == Object::Data);
        let open: Vec<_> = data.filter(|f| width(*f).is_none()).map(|f| f.info().name).collect();
        assert!(open.is_empty(), "{open:?}");
    }
}
