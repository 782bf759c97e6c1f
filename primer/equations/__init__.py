"""Equations as text: how they are written, as ``primer help equations`` says it too.

  u_t = u_xxx - 2u_xx + u u_x         derivatives are subscripts; a blank, a number
  (h u)_t + (h u^2)_x = 0             or a bracket multiplies; brackets have derivatives
  u_t = v_x; v_t = u_x                parted by ; or , or new lines, # begins a comment

The same derivative:  u_xx  u_{xx}  ∂_x∂_x u  ∂²u/∂x²  d²u/dx²  dx(dx(u))  (u)_xx
  \\partial_{xx} u    \\frac{\\partial^2 u}{\\partial x^2}    and of a bracket:  d/dx(u u_x)
Of symbol -i sign(xi) and |xi|, on what is linear:  H(u_xx + 2u)  absD(u)
In all space variables:  lap(u)  Δu  ∇²u   div(D grad(u))  ∇·(D∇u)   |grad(u)|^2
An operator takes the next name or bracket and no more.

Variables are x, y, z and t, or those declared: space="r"  space="x, z"  time="tau".
Functions: sin cos tan asin acos atan sinh cosh tanh sech exp log (ln) sqrt abs (|u|)
  sign erf max min, e^u. Numbers: 2, 1e-3, pi, i (the imaginary unit), 3i. c² is c^2.
ν, \\nu and nu are one name. Your own f(u) or D(x):  f="u^3 - u"  D=lambda x: 1 + x**2

Every other name needs a value; unknowns and their derivatives have base values:
  Python  verdict("u_t = nu*u_xx + u u_x", at={"u": 1, "u_x": 0}, nu=0.1)
  shell   primer verdict "u_t = nu*u_xx + u u_x" --at u=1 u_x=0 nu=0.1
If the base state is uniform, uniform=True (--uniform) sets all its derivatives to 0.
An array as a value gives an array of answers. Lists and sympy's Eq are taken, too.

What can be read in two ways is refused, with both:  u(x)  uxx  a/b c  ∂_x u v
"""
