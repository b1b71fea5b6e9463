! SPDX-License-Identifier: BSD-3-Clause
! The representative volume element for programs in Fortran: the functions of dem/rve/isostat_rve.h, which says what each
! does. Compile this file with your program.
!
!     type(c_ptr) :: rve = c_null_ptr, start = c_null_ptr     handles of an element and of a state
!
! Matrices go row by row: where h(i, j) is du_i/dx_j, the argument is transpose(h). Vectors of 6: xx, yy, zz, yz, xz, xy.
! Texts end in c_null_char: trim(path)//c_null_char. Optional arguments that are left out are null pointers of C.
! tested: tests/examples_test.py
module isostat_rve
  use, intrinsic :: iso_c_binding
  implicit none
  public

  integer(c_int), parameter :: isostat_ok = 0, isostat_rejected = 1, isostat_bad_input = 2, isostat_failure = 3

  type, bind(c) :: isostat_rve_settings
    real(c_double) :: inertial_number, strain_rate, damping, frame(3, 3), max_increment
    integer(c_int64_t) :: min_steps, max_steps
  end type

  type, bind(c) :: isostat_rve_response
    real(c_double) :: stress(6), mean_stress_change, indicator
    integer(c_int64_t) :: steps
  end type

  interface
    subroutine isostat_rve_default_settings(settings) bind(c)
      import :: isostat_rve_settings
      type(isostat_rve_settings), intent(out) :: settings
    end subroutine

    integer(c_int) function isostat_rve_create(specimen, settings, rve) bind(c)
      import :: c_char, c_int, c_ptr, isostat_rve_settings
      character(kind=c_char), intent(in) :: specimen(*)
      type(isostat_rve_settings), intent(in), optional :: settings
      type(c_ptr), intent(out) :: rve
    end function

    subroutine isostat_rve_destroy(rve) bind(c)
      import :: c_ptr
      type(c_ptr), value :: rve
    end subroutine

    integer(c_int) function isostat_rve_advance(rve, gradient, response) bind(c)
      import :: c_double, c_int, c_ptr, isostat_rve_response
      type(c_ptr), value :: rve
      real(c_double), intent(in) :: gradient(3, 3)
      type(isostat_rve_response), intent(out), optional :: response
    end function

    integer(c_int) function isostat_rve_undrained(rve, gradient, response) bind(c)
      import :: c_double, c_int, c_ptr, isostat_rve_response
      type(c_ptr), value :: rve
      real(c_double), intent(in) :: gradient(3, 3)
      type(isostat_rve_response), intent(out), optional :: response
    end function

    integer(c_int) function isostat_rve_mixed(rve, gradient, stress, controlled, tolerance, response) bind(c)
      import :: c_double, c_int, c_ptr, isostat_rve_response
      type(c_ptr), value :: rve
      real(c_double), intent(in) :: gradient(3, 3), stress(6)
      integer(c_int), intent(in) :: controlled(6)
      real(c_double), value :: tolerance
      type(isostat_rve_response), intent(out), optional :: response
    end function

    integer(c_int) function isostat_rve_stress(rve, stress) bind(c)
      import :: c_double, c_int, c_ptr
      type(c_ptr), value :: rve
      real(c_double), intent(out) :: stress(6)
    end function

    integer(c_int) function isostat_rve_stiffness(rve, yielding_contacts_resist, stiffness) bind(c)
      import :: c_double, c_int, c_ptr
      type(c_ptr), value :: rve
      integer(c_int), value :: yielding_contacts_resist
      real(c_double), intent(out) :: stiffness(6, 6)
    end function

    integer(c_int) function isostat_rve_void_ratio(rve, void_ratio) bind(c)
      import :: c_double, c_int, c_ptr
      type(c_ptr), value :: rve
      real(c_double), intent(out) :: void_ratio
    end function

    integer(c_int) function isostat_rve_densities(rve, water, dry, saturated) bind(c)
      import :: c_double, c_int, c_ptr
      type(c_ptr), value :: rve
      real(c_double), value :: water
      real(c_double), intent(out), optional :: dry, saturated
    end function

    integer(c_int) function isostat_rve_steps(rve, steps) bind(c)
      import :: c_int, c_int64_t, c_ptr
      type(c_ptr), value :: rve
      integer(c_int64_t), intent(out) :: steps
    end function

    integer(c_int) function isostat_rve_save(rve, state) bind(c)
      import :: c_int, c_ptr
      type(c_ptr), value :: rve
      type(c_ptr), intent(inout) :: state
    end function

    integer(c_int) function isostat_rve_restore(rve, state) bind(c)
      import :: c_int, c_ptr
      type(c_ptr), value :: rve, state
    end function

    subroutine isostat_rve_state_destroy(state) bind(c)
      import :: c_ptr
      type(c_ptr), value :: state
    end subroutine

    ! bytes: c_loc of an array, or c_null_ptr
    integer(c_int) function isostat_rve_pack(rve, bytes, size) bind(c)
      import :: c_int, c_ptr, c_size_t
      type(c_ptr), value :: rve, bytes
      integer(c_size_t), intent(inout) :: size
    end function

    integer(c_int) function isostat_rve_unpack(bytes, size, settings, rve) bind(c)
      import :: c_int, c_ptr, c_size_t, isostat_rve_settings
      type(c_ptr), value :: bytes
      integer(c_size_t), value :: size
      type(isostat_rve_settings), intent(in), optional :: settings
      type(c_ptr), intent(out) :: rve
    end function
  end interface

contains

  ! What went wrong in the last call that did not return isostat_ok.
  function isostat_rve_error() result(message)
    interface
      type(c_ptr) function text_of_error() bind(c, name="isostat_rve_error")
        import :: c_ptr
      end function

      integer(c_size_t) function length_of(text) bind(c, name="strlen")
        import :: c_ptr, c_size_t
        type(c_ptr), value :: text
      end function
    end interface
    character(:), allocatable :: message
    type(c_ptr) :: text
    character(kind=c_char), pointer :: letters(:)
    integer :: n
    text = text_of_error()
    call c_f_pointer(text, letters, [length_of(text)])
    allocate (character(size(letters)) :: message)
    do n = 1, size(letters)
      message(n:n) = letters(n)
    end do
  end function
end module
