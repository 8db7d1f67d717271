// placed, exported by scc
//   povray +ITHIS.pov +OIMAGE.png +W320 +H240 +FN16 File_Gamma=1.0 -A -D
#version 3.7;

// Declare=scc_exposure=0.25 on the command line makes the picture four times darker.
#ifndef (scc_exposure) #declare scc_exposure = 1; #end
global_settings {
    assumed_gamma 1.0
    max_trace_level 1
    adc_bailout 0
    ambient_light rgb scc_exposure*0.1
}
#default { finish { ambient 0 diffuse 0 specular 0 } }
background { rgb scc_exposure*0.0 }

// ---- camera ----

camera {
    orthographic
    location <3.6018085804406064, 3.7526136624629403, 4.8368239217652835>
    direction <-0.4242640687119285, -0.565685424949238, -0.7071067811865475>
    right <5.1449575542752655, 0.0, -3.0869745325651596>*image_width/image_height
    up <-1.7462565002615975, 4.947726750741192, -2.9104275004359956>
}

// ---- per-point functions ----

#declare f_bands_diffuse = function(x, y, z) { (0.5 + (0.5 * sin((8.0 * y)))) }
#declare f_bands_shininess = function(x, y, z) { (10.0 + abs(x)) }

// ---- materials ----

#macro m_bands_of_pair_sphere_at(shininess)
    texture {
        pigment {
            function { min(max(f_bands_diffuse(x, y, z), 0), 1) }
            color_map { [0 rgb <0.9, 0.2, 0.1>] [1 rgb <0.1, 0.2, 0.9>] }
        }
        finish { ambient rgb 1.0 diffuse 1.0 specular 0.5 roughness 1/shininess }
    }
#end
#declare m_bands_of_pair_sphere_stops = array[27];
#for (stop, 0, 26)
    #declare m_bands_of_pair_sphere_stops[stop] = m_bands_of_pair_sphere_at(10.0*exp(0.12804358494652313*stop/26))
#end
#declare m_bands_of_pair_sphere = texture {
    function { min(max(ln(max(min(max((f_bands_shininess(x*(0.8660254037844387) + z*(0.49999999999999994) + (0.0), y*(0.5) + (1.0), x*(-0.49999999999999994) + z*(0.8660254037844387) + (0.0)) - (10.0))/1.3660254037844428, 0), 1)*(1.3660254037844428) + (10.0), 10.0)/10.0)/(0.12804358494652313), 0), 1) }
    texture_map { #for (stop, 0, 26) [stop/26 m_bands_of_pair_sphere_stops[stop]] #end }
}
#declare m_default = texture { pigment { rgb 0.8 } finish { ambient rgb 1.0 diffuse 1.0 } }

// ---- objects ----

// pair/sphere
sphere {
    <0.0, 0.0, 0.0>, 1.0
    texture { m_bands_of_pair_sphere }
    matrix <0.8660254037844387, 0.0, -0.49999999999999994,  0.0, 0.5, 0.0,  0.49999999999999994, 0.0, 0.8660254037844387,  0.0, 1.0, 0.0>
    no_shadow
}
// pair/triangle
smooth_triangle {
    <0.0, 0.0, 0.0>, <0.49999999999999994, 0.0, 0.8660254037844387>,
    <0.8660254037844387, 0.0, -0.49999999999999994>, <0.3535533905932737, 0.7071067811865475, 0.6123724356957945>,
    <0.0, 1.0, 0.0>, <0.9659258262890682, 0.0, 0.2588190451025208>
    texture { m_default }
    no_shadow
}
// disc
disc {
    <0.0, -1.0, 0.0>, <0.0, 1.0, 0.0>, 3.0, 0.5
    texture { m_default }
    no_shadow
}

// ---- lights ----

// point_light
light_source { <2.0, 5.0, 3.0> rgb scc_exposure*<1.0, 0.5, 0.5> fade_distance 5.0 fade_power 1.0 }
light_source { <2.0, 5.0, 3.0> rgb scc_exposure*<-0.09999999999999998, 0.4, 0.4> fade_distance 5.0 fade_power 1.0 shadowless }
