"""A column that settles, against LIGGGHTS."""


from verification.measures.impacts import centre_charts, measured
from verification.measures.measures import Measures

MEASURES = Measures(observables=measured("height", "middle", "fall_time"), charts_of_both=centre_charts)
