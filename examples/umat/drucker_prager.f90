! SPDX-License-Identifier: BSD-3-Clause
! The perfectly plastic soil of Drucker and Prager (1952, Quarterly of Applied Mathematics 10, 157) as a UMAT, for the
! material "umat" of a layer (docs/column.md, Materials).
!
!     gfortran -O2 -shared -fPIC -o drucker_prager.so drucker_prager.f90
!
! PROPS = [G (Pa), nu, phi (deg), c (Pa), psi (deg)]. STATEV(1), if there is one, gathers the plastic multiplier.
! With the tension-positive I1 = tr(sigma) and q = sqrt(J2):
!
!     strength   f = q + alpha I1 - k <= 0
!     flow       of g = q + beta I1        (Drucker and Prager's own is associated, beta = alpha)
!     alpha = 2 sin(phi) / (sqrt(3) (3 - sin(phi))),   k = 6 c cos(phi) / (sqrt(3) (3 - sin(phi)))
!
! and beta as alpha with psi: the cone has the strength of Mohr and Coulomb in triaxial compression. The return from an
! elastic trial stress is closed (de Souza Neto, Peric and Owen 2008, Computational Methods for Plasticity, 8.3): with
! dl = f_trial / (G + 9 K alpha beta)
!
!     q = q_trial - G dl,   I1 = I1_trial - 9 K beta dl       on the cone while q >= 0, else
!     q = 0,                I1 = k / alpha                    at its apex
!
! DDSDDE is the derivative of this.   tested: tests/fem/material/umat_test.cpp
subroutine umat(stress, statev, ddsdde, sse, spd, scd, rpl, ddsddt, drplde, drpldt, stran, dstran, time, dtime, temp, &
                dtemp, predef, dpred, cmname, ndi, nshr, ntens, nstatv, props, nprops, coords, drot, pnewdt, celent, &
                dfgrd0, dfgrd1, noel, npt, layer, kspt, kstep, kinc)
  implicit none
  integer, parameter :: dp = kind(1.0d0)
  character(80), intent(in) :: cmname
  integer, intent(in) :: ndi, nshr, ntens, nstatv, nprops, noel, npt, layer, kspt, kstep(4), kinc
  real(dp), intent(in) :: stran(ntens), dstran(ntens), time(2), dtime, temp, dtemp, predef(1), dpred(1)
  real(dp), intent(in) :: props(nprops), coords(3), drot(3, 3), celent, dfgrd0(3, 3), dfgrd1(3, 3)
  real(dp), intent(inout) :: stress(ntens), statev(nstatv), sse, spd, scd, rpl, pnewdt
  real(dp), intent(inout) :: ddsdde(ntens, ntens), ddsddt(ntens), drplde(ntens), drpldt

  real(dp), parameter :: unity(6) = [1, 1, 1, 0, 0, 0], degree = acos(-1.0_dp)/180
  real(dp) :: elastic(6, 6), shear, bulk, alpha, beta, k, deviator(6), direction(6), i1, q, excess, multiplier, resistance
  integer :: i

  shear = props(1)
  bulk = 2*shear*(1 + props(2))/(3*(1 - 2*props(2)))
  alpha = slope(props(3))
  k = 6*props(4)*cos(props(3)*degree)/(sqrt(3.0_dp)*(3 - sin(props(3)*degree)))
  beta = slope(props(5))

  elastic = (bulk - 2*shear/3)*outer(unity, unity)
  do i = 1, 6
    elastic(i, i) = elastic(i, i) + merge(2, 1, i <= 3)*shear
  end do
  stress = stress + matmul(elastic, dstran)
  ddsdde = elastic
  i1 = sum(stress(1:3))
  deviator = stress - i1/3*unity
  q = sqrt(sum(deviator(1:3)**2)/2 + sum(deviator(4:6)**2))
  excess = q + alpha*i1 - k
  if (excess <= 0) return

  resistance = shear + 9*bulk*alpha*beta
  multiplier = excess/resistance
  if (shear*multiplier < q) then
    direction = deviator/q
    stress = (1 - shear*multiplier/q)*deviator + (i1/3 - 3*bulk*beta*multiplier)*unity
    ddsdde = bulk*outer(unity, unity) + (1 - shear*multiplier/q)*(elastic - bulk*outer(unity, unity)) &
             + shear**2*multiplier/q*outer(direction, direction) &
             - outer(shear*direction + 3*bulk*beta*unity, shear*direction + 3*bulk*alpha*unity)/resistance
  else
    multiplier = q/shear
    stress = k/(3*alpha)*unity
    ddsdde = 1e-6_dp*elastic ! the derivative is zero: what Newton's method can do with
  end if
  if (nstatv > 0) statev(1) = statev(1) + multiplier

contains

  pure real(dp) function slope(angle)
    real(dp), intent(in) :: angle
    slope = 2*sin(angle*degree)/(sqrt(3.0_dp)*(3 - sin(angle*degree)))
  end function

  pure function outer(a, b)
    real(dp), intent(in) :: a(6), b(6)
    real(dp) :: outer(6, 6)
    outer = spread(a, 2, 6)*spread(b, 1, 6)
  end function
end subroutine
