! SPDX-License-Identifier: BSD-3-Clause
! The path of rve_in_c.c in Fortran: simple shear of a packing with closed pores, each increment tried twice as large first
! and taken back; half way the element becomes bytes and comes back; at the end the pores are opened.
!
!     rve_in_fortran SPECIMEN      a periodic specimen (.h5), or library.h5#s0001
program rve_in_fortran
  use isostat_rve
  implicit none
  real(c_double) :: gradient(3, 3), stress(6)
  integer(c_int), parameter :: open_pores(6) = [1, 1, 1, 0, 0, 0] ! normal stresses are kept, shear strains prescribed
  type(c_ptr) :: rve = c_null_ptr, start = c_null_ptr
  character(4096) :: specimen = "specimen.h5"
  integer :: n

  if (command_argument_count() > 0) call get_command_argument(1, specimen)
  call must(isostat_rve_create(trim(specimen)//c_null_char, rve=rve))
  gradient = 0
  gradient(1, 2) = 1.0e-4_c_double ! du_x/dy
  print '(a)', "increment  sigma_xx (Pa)  sigma_yy (Pa)  sigma_zz (Pa)  tau_xy (Pa)  e"
  call print_row(0)
  do n = 1, 10
    call must(isostat_rve_save(rve, start))
    call must(isostat_rve_undrained(rve, transpose(2*gradient)))
    call must(isostat_rve_restore(rve, start))
    call must(isostat_rve_undrained(rve, transpose(gradient)))
    call print_row(n)
    if (n == 5) call restart()
  end do
  call must(isostat_rve_stress(rve, stress))
  call must(isostat_rve_mixed(rve, transpose(gradient), stress, open_pores, 1.0e-3_c_double))
  call print_row(11)
  call isostat_rve_state_destroy(start)
  call isostat_rve_destroy(rve)

contains

  ! Ends the program where the packing cannot do what is asked for. A finite-element program would divide its step.
  subroutine must(status)
    integer(c_int), intent(in) :: status
    if (status == isostat_ok) return
    print '(a)', isostat_rve_error()
    stop 1
  end subroutine

  subroutine print_row(row)
    integer, intent(in) :: row
    real(c_double) :: s(6), e
    call must(isostat_rve_stress(rve, s))
    call must(isostat_rve_void_ratio(rve, e))
    print '(i0, 5(1x, es24.16e3))', row, s(1), s(2), s(3), s(6), e
  end subroutine

  ! The element as bytes and back; a restart file would hold them.
  subroutine restart()
    integer(c_signed_char), allocatable, target :: bytes(:)
    integer(c_size_t) :: size
    call must(isostat_rve_pack(rve, c_null_ptr, size))
    allocate (bytes(size))
    call must(isostat_rve_pack(rve, c_loc(bytes), size))
    call isostat_rve_destroy(rve)
    call must(isostat_rve_unpack(c_loc(bytes), size, rve=rve))
  end subroutine
end program
